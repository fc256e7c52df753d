#pragma once

#include <vector>

#include "spelunk/common/pose.h"

namespace spelunk {

/// What a robot's motion must stay within.
struct MotionLimits {
  double speed_mps = 2.0;
  double acceleration_mps2 = 2.0;
  double yaw_rate_radps = 1.0;
  double yaw_acceleration_radps2 = 2.0;
};

/// One timed state of a reference motion, world frame.
struct TrajectoryPoint {
  double time_s = 0.0;  ///< Mission time.
  Pose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  double yaw_rate = 0.0;
};

/// Points with strictly rising times. Between two points position is the cubic Hermite curve of
/// positions and velocities; after the last point the robot holds there.
using Trajectory = std::vector<TrajectoryPoint>;

/// The reference at `time_s`, clamped to the first and last point (there: at rest).
/// The trajectory must not be empty.
TrajectoryPoint stateAt(const Trajectory& trajectory, double time_s);

}  // namespace spelunk
