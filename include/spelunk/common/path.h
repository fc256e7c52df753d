#pragma once

#include <vector>

#include "spelunk/common/pose.h"

namespace spelunk {

/// Waypoints in the world frame, joined by straight segments.
using Path = std::vector<Pose>;

/// Sum of the segments' lengths, metres; 0 for fewer than two waypoints.
double lengthOf(const Path& path);

/// The pose `arc_m` metres along the path (clamped to its ends). The path must not be empty.
/// Position is interpolated on the segment, yaw along the shorter way round.
Pose poseAt(const Path& path, double arc_m);

/// The part of `path` between two arc lengths, both clamped to [0, length]; at least one pose.
Path slice(const Path& path, double from_m, double to_m);

/// The same line with waypoints at most `spacing_m` apart; all given waypoints are kept.
Path resampled(const Path& path, double spacing_m);

/// `path` from its end to its start, yaw unchanged.
Path reversed(const Path& path);

/// One path and then another one; waypoints where the line has just arrived are left out.
[[nodiscard]] Path joined(Path path, const Path& more);

/// Where `point` projects on the line.
struct PathProjection {
  double arc_m = 0.0;       ///< Arc length of the nearest point of the line.
  double distance_m = 0.0;  ///< Distance from the point to the line.
};

/// The nearest point of a non-empty path; the earliest one if several are equally near.
PathProjection project(const Path& path, const Eigen::Vector3d& point);

}  // namespace spelunk
