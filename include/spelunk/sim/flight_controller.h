#pragma once

#include <Eigen/Geometry>

#include "spelunk/common/pose.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/sim/rotors.h"

namespace spelunk::sim {

inline constexpr double kGravity = 9.81;  ///< m/s^2

/// What the controller knows of the vehicle it flies.
struct Airframe {
  double mass_kg = 1.0;
  Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Ones();  ///< Principal, base frame.
  double drag_coefficient = 0.0;                           ///< N s/m, linear.
  double thrust_max_n = 20.0;
};

/// Motion of a rigid body: its odometry plus what the gyroscope measures.
struct BodyState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< World frame.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< World from base.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< World frame, m/s.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       ///< Base frame, rad/s.
};

/// How far ahead of now, seconds, the reference's acceleration is asked for: the attitude needs
/// about that long to turn the thrust.
inline constexpr double kAccelerationPreview = 0.16;

/// Thrust and torque that bring `state` to `reference`: a position loop that asks for a force and
/// an attitude loop on SO(3) that turns the thrust there. Errors and tilt are limited so that a far
/// reference makes the robot fly there, not tumble. `acceleration_ahead` is the reference's
/// acceleration kAccelerationPreview from now.
///
/// T. Lee, M. Leok, N. H. McClamroch, "Geometric tracking control of a quadrotor UAV on SE(3)",
/// CDC 2010, section IV.
Wrench computeWrench(const Airframe& airframe, const BodyState& state,
                     const TrajectoryPoint& reference, const Eigen::Vector3d& acceleration_ahead);

/// A reference that brakes from the motion `from` at `deceleration_mps2`, starting at `time_s`, and
/// holds where it comes to rest. The heading turns out over the same time.
Trajectory brakingTrajectory(double time_s, const TrajectoryPoint& from, double deceleration_mps2);

}  // namespace spelunk::sim
