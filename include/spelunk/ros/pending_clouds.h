#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Geometry>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "spelunk/ros/cloud_filter.h"

namespace spelunk::bridge {

/// World from the frame of a message at its stamp, or why there is none.
using TransformLookup =
    std::function<FromMsg<Eigen::Isometry3d>(const std::string& frame, const ::ros::Time& stamp)>;

/// Clouds that wait for the transform at their stamp, oldest first. Times are ROS time.
class PendingClouds {
 public:
  /// A cloud with its pose, or one that had to be given up.
  struct Item {
    sensor_msgs::PointCloud2::ConstPtr cloud;
    Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
    std::string problem;  ///< Empty for a good cloud; else the thing and the remedy.
  };

  explicit PendingClouds(const CloudParams& params) : params_(params) {}

  /// Takes a cloud up. Returns what is wrong with its frame or stamp, if so; it is then not kept.
  /// More than kCapacity waiting clouds push out the oldest ones.
  [[nodiscard]] std::string push(const sensor_msgs::PointCloud2::ConstPtr& cloud,
                                 const ::ros::Time& now);

  /// The clouds whose transform is there, and those that waited too long.
  [[nodiscard]] std::vector<Item> take(const TransformLookup& lookup, const ::ros::Time& now);

  void clear() { waiting_.clear(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }

  static constexpr std::size_t kCapacity = 16;

 private:
  struct Waiting {
    sensor_msgs::PointCloud2::ConstPtr cloud;
    ::ros::Time since;
  };
  CloudParams params_;
  std::deque<Waiting> waiting_;
};

}  // namespace spelunk::bridge
