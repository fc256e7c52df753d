#pragma once

#include "spelunk/graph/path_similarity.h"
#include "spelunk/map/frozen_map.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners::gbplanner {

struct ImproveLimits {
  double shortcut_length_max_m = 8.0;
  double prune_length_m = 0.5;
  double inflation_radius_m = 2.5;
};

/// Replaces runs of vertices by straight segments up to the limit where these are free.
[[nodiscard]] graph::Polyline shortened(const graph::Polyline& path, const FreeSpace& space,
                                        double segment_length_max_m);

/// Drops inner vertices that are nearer than `length_m` to the one before, where the segment that
/// replaces the two edges is free.
[[nodiscard]] graph::Polyline pruned(const graph::Polyline& path, const FreeSpace& space,
                                     double length_m);

/// Where vertex b of the edge [a, b] has most room: the hyperplanes tangent to an ellipsoid
/// inflated along the edge until it meets occupied voxels of `map`, one after the other, bound a
/// polygon in the plane through b perpendicular to the edge; returns the polygon's centroid (Dang
/// 2020, section 4.4, after Liu et al. 2017). The polygon is at most `radius_m` wide each way.
/// Returns b if the edge has no length or the polygon is empty.
[[nodiscard]] Eigen::Vector3d roomiestPoint(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                            const map::FrozenMap& map, double radius_m);

/// ImprovePath (Dang 2020, section 4.4): short edges pruned, then every vertex but the first moved
/// to where it has most room, kept only if both its edges stay free. `path` must be free.
/// Differs from the paper: vertices that a straight free segment can skip are skipped first, so
/// that the robot keeps its speed; if the whole way to the centre is not free, half of it is tried.
[[nodiscard]] graph::Polyline improvedPath(const graph::Polyline& path, const FreeSpace& space,
                                           const map::FrozenMap& map, const ImproveLimits& limits);

}  // namespace spelunk::planners::gbplanner
