#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>

#include <optional>
#include <string>

#include "spelunk/common/self_returns.h"
#include "spelunk/ros/cloud_filter.h"
#include "spelunk/ros/cloud_places.h"
#include "spelunk/ros/mission_core.h"
#include "spelunk/ros/node_params.h"
#include "spelunk/ros/pending_clouds.h"
#include "spelunk/ros/sensor_watch.h"
#include "spelunk/ros/tf_input.h"

namespace spelunk::bridge {

/// What planner_node listens to. Has its own queue and thread, the only one that writes the map.
/// Bad messages are refused with a warning that names the thing and the remedy.
class PlannerInputs {
 public:
  /// `core` must outlive this.
  PlannerInputs(const ::ros::NodeHandle& node, const PlannerNodeParams& params,
                const CloudParams& cloud_params, GuardedCore& core);
  ~PlannerInputs();

 private:
  void onCloud(const sensor_msgs::PointCloud2::ConstPtr& cloud);
  void onOdometry(const nav_msgs::Odometry::ConstPtr& odometry);
  void onBattery(const sensor_msgs::BatteryState::ConstPtr& battery);
  void onTimer();

  void forgetAfterClockJump();
  void sayWhichSensorsAreMissing();
  void expectInputs();
  void enterReadyClouds(const ::ros::Time& now);
  void giveUp(const PendingClouds::Item& item, const ::ros::Time& now);
  void enter(const PendingClouds::Item& item);
  void sayIfCoarse(const sensor_msgs::PointCloud2& cloud, const CloudPlace& place);
  [[nodiscard]] std::optional<Eigen::Isometry3d> findBaseIn(const std::string& child);
  void takeOver(const nav_msgs::Odometry& odometry, const std::string& base_frame,
                const RobotState& state, const Eigen::Isometry3d& T_world_frame);
  [[nodiscard]] bool comesTooLate(const ::ros::Time& stamp);
  [[nodiscard]] FromMsg<Eigen::Isometry3d> findTransform(const std::string& frame,
                                                         const ::ros::Time& stamp) const;
  [[nodiscard]] FromMsg<Eigen::Isometry3d> findByOdometry(const std::string& frame,
                                                          const ::ros::Time& stamp) const;
  /// Whether tf knows the frame at any time.
  [[nodiscard]] bool hasTransform(const std::string& frame) const;
  void reportSenders(TfInput::SentByTwo what, const std::string& text);
  [[nodiscard]] FrameTree tree() const;
  void reportCloud(const std::string& key, const std::string& text);
  void reportOdometry(const std::string& key, const std::string& text);
  void report(const std::string& key, const std::string& text);

  PlannerNodeParams params_;
  CloudParams cloud_params_;
  GuardedCore& core_;
  double endurance_s_;
  double resolution_m_;  ///< Of the map.
  PendingClouds pending_;
  SensorWatch sensors_;
  std::uint64_t jumps_seen_ = 0;
  CloudPlaces places_;
  SelfReturns self_returns_;
  std::optional<::ros::Time> first_used_;  ///< Stamp of a cloud.
  std::optional<::ros::Time> first_given_up_;
  ::ros::Time newest_odometry_;
  std::string said_child_;      ///< The base is found from it.
  std::string odometry_frame_;  ///< Of the newest odometry, and where it was used.
  Eigen::Isometry3d T_world_odometry_ = Eigen::Isometry3d::Identity();
  int late_odometry_ = 0;  ///< Messages in a row that were older than one before.
  InputWatch::Wanted cloud_input_{};
  InputWatch::Wanted odometry_input_{};

  ::ros::NodeHandle node_;
  ::ros::CallbackQueue queue_;
  tf2_ros::Buffer tf_buffer_;
  TfInput tf_input_;
  ::ros::Subscriber cloud_subscriber_;
  ::ros::Subscriber odometry_subscriber_;
  ::ros::Subscriber battery_subscriber_;
  ::ros::Timer timer_;
  ::ros::AsyncSpinner spinner_;
};

}  // namespace spelunk::bridge
