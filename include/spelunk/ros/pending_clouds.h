#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "spelunk/ros/cloud_filter.h"
#include "spelunk/ros/cloud_places.h"

namespace spelunk::bridge {

/// Where a cloud in `frame` (no leading slash) was taken from at its stamp, or why that is not
/// known.
using PlaceLookup =
    std::function<FromMsg<CloudPlace>(const std::string& frame, const ::ros::Time& stamp)>;

/// Clouds that wait until it is known where they were taken from, oldest first. Times are ROS time.
class PendingClouds {
 public:
  /// A cloud with its place, or one that had to be given up.
  struct Item {
    sensor_msgs::PointCloud2::ConstPtr cloud;
    CloudPlace place;
    std::string problem;  ///< Empty for a good cloud; else the thing and the remedy.
  };

  explicit PendingClouds(const CloudParams& params) : params_(params) {}

  /// Takes a cloud up. Returns what is wrong with its frame or stamp, if so; it is then not kept.
  /// More than kCapacity waiting clouds push out the oldest ones.
  [[nodiscard]] std::string push(const sensor_msgs::PointCloud2::ConstPtr& cloud,
                                 const ::ros::Time& now);

  /// The clouds whose place is known, and those that waited too long.
  [[nodiscard]] std::vector<Item> take(const PlaceLookup& lookup, const ::ros::Time& now);

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
