#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace spelunk {

/// `angle_rad` wrapped to (-pi, pi].
double wrapAngle(double angle_rad);

/// A robot configuration xi = [x, y, z, psi] in the world frame (Dang 2020, section 3).
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double yaw = 0.0;
};

/// World from base for an upright robot at `pose`.
Eigen::Isometry3d T_world_base(const Pose& pose);

/// Position and heading of a base frame; roll and pitch are dropped.
Pose poseOf(const Eigen::Isometry3d& T_world_base);

inline double distance(const Pose& a, const Pose& b) { return (a.position - b.position).norm(); }

inline bool isFinite(const Pose& pose) {
  return pose.position.allFinite() && std::isfinite(pose.yaw);
}

/// What odometry knows of the robot at one instant, in the world frame.
struct RobotState {
  double stamp_s = 0.0;
  Pose pose;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< World from base.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< World frame, m/s.
  double yaw_rate = 0.0;                                            ///< rad/s about world z.
};

}  // namespace spelunk
