#pragma once

#include "spelunk/common/robot_model.h"
#include "spelunk/sim/flight_controller.h"
#include "spelunk/sim/motion_reference.h"
#include "spelunk/sim/walker_params.h"

namespace spelunk::sim {

/// Slower backwards and sideways.
[[nodiscard]] DriveLimits walkingLimits(const RobotModel& robot, const WalkerParams& params);

/// Turns a reference into the velocity a walking robot steps at.
class WalkTracker {
 public:
  WalkTracker(const RobotModel& robot, const WalkerParams& params);

  /// The velocity to go at now, reached with limited acceleration. A reference that runs away is
  /// held back. At rest near its goal the robot stands: all zero.
  DriveCommand advance(double step_s, double time_s, const BodyState& estimate,
                       MotionReference& reference);

 private:
  DriveLimits limits_;
  double acceleration_;
  double yaw_acceleration_;
  DriveCommand command_;
  bool is_resting_ = true;
};

}  // namespace spelunk::sim
