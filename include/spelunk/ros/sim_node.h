#pragma once

#include <geometry_msgs/Twist.h>
#include <nav_msgs/Path.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/Bool.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>
#include <visualization_msgs/Marker.h>

#include <optional>
#include <vector>

#include "spelunk/common/log.h"
#include "spelunk/ros/node_setup.h"
#include "spelunk/ros/sender_watch.h"
#include "spelunk/ros/walker_outputs.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::bridge {

/// A robot in a mesh as a ROS node: publishes /clock (or follows it, with ~clock false), tf (world
/// -> base_link -> each sensor, the robot's own with ~frame_prefix before them), `odometry`,
/// `pointcloud` (sensor frame), `battery`, `collisions` (std_msgs/UInt32, the number of contacts so
/// far, latched), the world as a marker (`mesh`), the parameter `robot_description` and, of a
/// walking robot, what WalkerOutputs has. Follows `command/trajectory` or, from senders without it,
/// `path`; `cmd_vel` drives the robot until it lapses or one of them comes. One thread.
///
/// All that is in the frame of the mesh file, save what RViz turns into 32-bit numbers (`mesh`,
/// `feet`): where the mesh is held around another origin, these are in the frame `local_mesh`.
class SimNode {
 public:
  SimNode(const ::ros::NodeHandle& node, const SimSetup& setup, const SimWorld& world);

  /// Simulates until ROS shuts down, `speed_factor` times as fast as real time or as /clock says,
  /// or as fast as the machine can if that is slower.
  void run();

 private:
  void runByClock();
  void step(double time_s);
  /// ROS time of a time of the simulator.
  [[nodiscard]] ::ros::Time stampOf(double time_s) const { return ::ros::Time(begin_s_ + time_s); }
  void publishClock();
  void publishState();
  void publishScans(const std::vector<sim::SimulatedScan>& scans);
  void publishBattery();
  void publishCollisions();
  void onClock(const ::ros::MessageEvent<rosgraph_msgs::Clock const>& event);
  void onTrajectory(const trajectory_msgs::MultiDOFJointTrajectory::ConstPtr& message);
  void onPath(const nav_msgs::Path::ConstPtr& message);
  void onStand(const std_msgs::Bool::ConstPtr& message);
  void onDrive(const geometry_msgs::Twist::ConstPtr& message);
  void refuse(const std::string& what, const std::string& problem);

  SimNodeParams params_;
  RobotModel robot_;
  LocalFrame frame_;  ///< Of the simulator; its caller's frame is the world frame.
  std::string base_frame_;
  std::string local_frame_;  ///< Frame id of what is in `frame_`.
  visualization_msgs::Marker mesh_;
  sim::Simulator simulator_;
  Throttle throttle_;
  SenderWatch senders_;
  double begin_s_ = 0.0;             ///< ROS time at the simulator's time 0.
  bool obeys_trajectories_ = false;  ///< One has come: `path`, the same untimed, is not followed.
  double next_battery_s_ = 0.0;
  std::optional<int> collisions_said_;

  ::ros::NodeHandle node_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  ::ros::Publisher clock_;
  ::ros::Publisher odometry_;
  ::ros::Publisher cloud_;
  ::ros::Publisher battery_;
  ::ros::Publisher collisions_;
  ::ros::Publisher mesh_publisher_;
  ::ros::Subscriber clock_subscriber_;
  ::ros::Subscriber trajectory_subscriber_;
  ::ros::Subscriber path_subscriber_;
  ::ros::Subscriber drive_subscriber_;
  ::ros::Subscriber stand_subscriber_;
  std::optional<WalkerOutputs> walker_outputs_;
};

}  // namespace spelunk::bridge
