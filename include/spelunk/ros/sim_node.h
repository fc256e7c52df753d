#pragma once

#include <geometry_msgs/Twist.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>
#include <visualization_msgs/Marker.h>

#include <optional>
#include <vector>

#include "spelunk/common/log.h"
#include "spelunk/ros/node_setup.h"
#include "spelunk/ros/walker_outputs.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::bridge {

/// A robot in a mesh as a ROS node: publishes /clock, tf (world -> base_link -> each sensor),
/// `odometry`, `pointcloud` (sensor frame), `battery`, `collisions` (std_msgs/UInt32, the number
/// of contacts so far, latched), the world as a marker (`mesh`), the parameter `robot_description`
/// and, of a walking robot, what WalkerOutputs has. Follows `command/trajectory` or, from senders
/// without it, `path`; `cmd_vel` drives the robot until it lapses or one of them comes. One thread.
class SimNode {
 public:
  SimNode(const ::ros::NodeHandle& node, const SimSetup& setup, const SimWorld& world);

  /// Simulates until ROS shuts down, `speed_factor` times as fast as real time, or as fast as the
  /// machine can if that is slower.
  void run();

 private:
  void step(double time_s);
  void publishClock();
  void publishState();
  void publishScans(const std::vector<sim::SimulatedScan>& scans);
  void publishBattery();
  void publishCollisions();
  void onTrajectory(const trajectory_msgs::MultiDOFJointTrajectory::ConstPtr& message);
  void onPath(const nav_msgs::Path::ConstPtr& message);
  void onDrive(const geometry_msgs::Twist::ConstPtr& message);
  void refuse(const std::string& what, const std::string& problem);

  SimNodeParams params_;
  RobotModel robot_;
  visualization_msgs::Marker mesh_;
  sim::Simulator simulator_;
  Throttle throttle_;
  bool obeys_trajectories_ = false;  ///< One has come: `path`, the same untimed, is not followed.
  double next_battery_s_ = 0.0;
  std::optional<int> collisions_said_;

  ::ros::NodeHandle node_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ::ros::Publisher clock_;
  ::ros::Publisher odometry_;
  ::ros::Publisher cloud_;
  ::ros::Publisher battery_;
  ::ros::Publisher collisions_;
  ::ros::Publisher mesh_publisher_;
  ::ros::Subscriber trajectory_subscriber_;
  ::ros::Subscriber path_subscriber_;
  ::ros::Subscriber drive_subscriber_;
  std::optional<WalkerOutputs> walker_outputs_;
};

}  // namespace spelunk::bridge
