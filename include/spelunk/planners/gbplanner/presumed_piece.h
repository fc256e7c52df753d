#pragma once

#include "spelunk/graph/path_similarity.h"
#include "spelunk/map/presumed_ways.h"
#include "spelunk/planners/gbplanner/local_graph.h"
#include "spelunk/planners/shared/presumed_way.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::gbplanner {

/// The next piece of a presumed way that can be flown: the path in the local graph from its root
/// that comes nearest to the target for its length. `to_target`: presumed ways from the target.
/// Empty if none brings the robot 3 m nearer, other than to places that were tried and failed.
[[nodiscard]] graph::Polyline pieceTowards(const LocalGraph& local,
                                           const map::PresumedWays& to_target,
                                           const TriedTargets& tried);

}  // namespace spelunk::planners::gbplanner
