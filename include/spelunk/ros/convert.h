#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/PointCloud2.h>
#include <spelunk/Graph.h>
#include <spelunk/PlannerStatus.h>
#include <spelunk/SetNoGoZones.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/local_frame.h"
#include "spelunk/common/path.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/mission/mission.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::bridge {

/// A message turned into a value of the core, or why it cannot be.
template <class T>
struct FromMsg {
  std::optional<T> value;
  std::string problem;  ///< One sentence; empty if there is a value.
};

// --- Messages from values. Positions are in `frame`; stamps are ROS time.

[[nodiscard]] geometry_msgs::Point toMsg(const Eigen::Vector3d& point);
[[nodiscard]] geometry_msgs::Pose toMsg(const Pose& pose);
/// The state of the base of a robot whose odometry is that of another frame on it (a camera's).
[[nodiscard]] RobotState ofBase(const RobotState& child, const Eigen::Isometry3d& T_child_base);
[[nodiscard]] nav_msgs::Path toMsg(const Path& path, const std::string& frame,
                                   const ::ros::Time& stamp);

/// `start` is the ROS time of the first point. An empty trajectory says "stop and hold".
[[nodiscard]] trajectory_msgs::MultiDOFJointTrajectory toMsg(const Trajectory& trajectory,
                                                             const std::string& frame,
                                                             const ::ros::Time& start);
/// Velocities in the message are in the body frame, as nav_msgs/Odometry asks.
[[nodiscard]] nav_msgs::Odometry toMsg(const RobotState& state, const std::string& frame,
                                       const std::string& body_frame, const ::ros::Time& stamp);
/// Where the origin of a local frame lies, for tf: from `world` to `local`.
[[nodiscard]] geometry_msgs::TransformStamped frameMsg(const LocalFrame& frame,
                                                       const std::string& world,
                                                       const std::string& local,
                                                       const ::ros::Time& stamp);
[[nodiscard]] PlannerStatus toMsg(const mission::MissionStatus& status, const std::string& frame,
                                  const ::ros::Time& stamp);
[[nodiscard]] Graph toMsg(const planners::PlannerGraph& graph, const std::string& frame,
                          const ::ros::Time& stamp);
/// Three float32 fields x, y, z, one point after the other.
[[nodiscard]] sensor_msgs::PointCloud2 toMsg(const std::vector<Eigen::Vector3f>& points,
                                             const std::string& frame, const ::ros::Time& stamp);

// --- Values from messages. Not finite numbers, quaternions of zero length and frames other than
// `frame` are refused.

[[nodiscard]] FromMsg<Eigen::Isometry3d> fromMsg(const geometry_msgs::Pose& message);
[[nodiscard]] FromMsg<Path> fromMsg(const nav_msgs::Path& message, const std::string& frame);
/// Times of the result are ROS time in seconds.
[[nodiscard]] FromMsg<Trajectory> fromMsg(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                          const std::string& frame);
/// `T_world_frame` brings the message's frame into the world. The stamp is ROS time.
[[nodiscard]] FromMsg<RobotState> fromMsg(const nav_msgs::Odometry& message,
                                          const Eigen::Isometry3d& T_world_frame);
[[nodiscard]] FromMsg<AxisAlignedBox> boundsFromMsg(const geometry_msgs::Point& min,
                                                    const geometry_msgs::Point& max);
[[nodiscard]] FromMsg<std::vector<NoGoZone>> fromMsg(const SetNoGoZones::Request& request);
/// How far the corners of a request may lie from where they were meant to, because they are 32-bit
/// numbers, metres.
[[nodiscard]] double cornerError(const SetNoGoZones::Request& request);

/// Flight time a battery has left, seconds: the smaller one of what its charge and current say and
/// of what its percentage says, taking `endurance_s` for a full battery.
[[nodiscard]] FromMsg<double> remainingFromMsg(const sensor_msgs::BatteryState& message,
                                               double endurance_s);

}  // namespace spelunk::bridge
