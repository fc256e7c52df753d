#pragma once

#include <vector>

#include "spelunk/common/path.h"
#include "spelunk/common/trajectory.h"

namespace spelunk::navigation {

/// What the robot is doing where a trajectory begins.
struct MotionStart {
  double time_s = 0.0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double yaw_rate = 0.0;
};

/// A piece of a path, metres of arc from its start, that is flown no faster than `speed_mps`.
struct SlowPiece {
  double from_m = 0.0;
  double to_m = 0.0;
  double speed_mps = 0.0;
};

/// The path timed within the limits: speed along it rises and falls with bounded acceleration,
/// slows where the line bends (so that the robot stays within `corner_tolerance_m` of it) and where
/// the heading has to turn, and ends at rest. Starts with the part of `start.velocity` along the
/// path. The heading looks along the direction of motion. Throws Precondition for an empty path or
/// a slow piece without speed.
[[nodiscard]] Trajectory timed(const Path& path, const MotionLimits& limits,
                               const MotionStart& start, double corner_tolerance_m = 0.1,
                               const std::vector<SlowPiece>& slow = {});

/// Time `timed` needs from rest to rest, without building it point by point.
[[nodiscard]] double travelTime(const Path& path, const MotionLimits& limits,
                                const std::vector<SlowPiece>& slow = {});

}  // namespace spelunk::navigation
