#pragma once

#include <optional>
#include <vector>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/map/presumed_ways.h"
#include "spelunk/planners/gbplanner/local_graph.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::gbplanner {

/// How far along a way presumed ways are looked for, metres.
inline constexpr double kPresumedReach_m = 300.0;

/// The next piece of a presumed way that can be flown: the path in the local graph from its root
/// that comes nearest to the target for its length. `to_target`: presumed ways from the target.
/// Empty if none brings the robot 3 m nearer, other than to places that were tried and failed.
[[nodiscard]] graph::Polyline pieceTowards(const LocalGraph& local,
                                           const map::PresumedWays& to_target,
                                           const TriedTargets& tried);

/// Where a presumed way is to be closed if no piece of it can be flown: just ahead of its start.
[[nodiscard]] std::optional<map::ClosedPlace> placeAhead(const std::vector<Eigen::Vector3d>& way);

}  // namespace spelunk::planners::gbplanner
