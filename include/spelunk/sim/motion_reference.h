#pragma once

#include <optional>

#include "spelunk/common/trajectory.h"
#include "spelunk/sim/flight_controller.h"

namespace spelunk::sim {

/// A velocity in the robot's own heading frame.
struct DriveCommand {
  double forward_mps = 0.0;
  double sideways_mps = 0.0;  ///< To the left.
  double yaw_rate_radps = 0.0;
};

/// How fast a robot can go in its own heading frame.
struct DriveLimits {
  double forward_mps = 2.0;
  double backward_mps = 2.0;
  double sideways_mps = 2.0;
  double yaw_rate_radps = 1.0;
};

/// A drive command lapses after so many seconds without a new one.
inline constexpr double kDriveTimeout = 0.5;

/// `command` with each part clamped to its limit.
[[nodiscard]] DriveCommand clamped(const DriveCommand& command, const DriveLimits& limits);

/// What a robot is to do now: a timed trajectory, or a velocity that lapses. Poses are in the frame
/// of the odometry.
class MotionReference {
 public:
  MotionReference(const Pose& start, double braking_mps2);

  /// An empty trajectory brakes from the motion `estimate` and holds.
  void follow(Trajectory trajectory, double time_s, const BodyState& estimate);

  /// Drives with `command` until time_s + kDriveTimeout, then brakes and holds.
  void drive(const DriveCommand& command, double time_s);

  /// To be called before each step: a drive command may lapse.
  void update(double time_s, const BodyState& estimate);

  /// The state to be in. While driving: where `estimate` is, at the commanded velocity.
  [[nodiscard]] TrajectoryPoint at(double time_s, const BodyState& estimate) const;

  /// Moves what is left of the trajectory into the future: the robot could not keep up.
  void holdBack(double delay_s) { delay_s_ += delay_s; }

 private:
  Trajectory trajectory_;
  double braking_mps2_;
  double delay_s_ = 0.0;
  std::optional<DriveCommand> drive_;
  double drive_until_s_ = 0.0;
};

}  // namespace spelunk::sim
