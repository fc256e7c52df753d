#pragma once

#include <geometry_msgs/Twist.h>
#include <sensor_msgs/JointState.h>

#include <Eigen/Geometry>
#include <vector>

#include "spelunk/ros/convert.h"
#include "spelunk/sim/simulator.h"
#include "spelunk/visualization/draw_terrain.h"

namespace spelunk::bridge {

/// Names and angles; velocities and efforts are not simulated and stay empty.
[[nodiscard]] sensor_msgs::JointState toMsg(const sim::JointState& joints,
                                            const ::ros::Time& stamp);

/// The base in the world, roll and pitch included.
[[nodiscard]] Eigen::Isometry3d T_world_body(const RobotState& state);

/// Forward, sideways and turning; what else the message holds does nothing, but must be finite.
[[nodiscard]] FromMsg<sim::DriveCommand> fromMsg(const geometry_msgs::Twist& message);

/// Feet as marks in the world.
[[nodiscard]] std::vector<visualization::FootMark> marksOf(const std::vector<sim::FootState>& feet,
                                                           const Eigen::Isometry3d& T_world_base);

}  // namespace spelunk::bridge
