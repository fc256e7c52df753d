#pragma once

#include "spelunk/common/rng.h"
#include "spelunk/graph/shortest_paths.h"
#include "spelunk/graph/spatial_graph.h"
#include "spelunk/map/free_voxels.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners::gbplanner {

/// A random graph in the free space around its root; edges weigh their length, times
/// tightness_cost where the safety margin does not fit.
struct LocalGraph {
  graph::SpatialGraph graph;
  graph::VertexId root{};
};

/// BuildLocalGraph (Dang 2020, Alg. 2) from what `sampler` draws around `root`, which must be free.
/// Stops at max_vertices, max_edges or when the budget is used up. Counts samples and rejections by
/// reason into `stats`. Differs from the paper: a sample farther than edge_length_max_m from its
/// nearest vertex is pulled to that distance, since straight lines across a whole box are seldom
/// free in galleries; one nearer than edge_length_min_m is dropped, since it would see what its
/// neighbour sees; and a graph that has not filled up after a fifth of its samples stands in a
/// tight place, where blocked steps are tried again at a half, a quarter, ... of their length.
[[nodiscard]] LocalGraph buildLocalGraph(const Eigen::Vector3d& root,
                                         const map::FreeVoxels& sampler, const FreeSpace& space,
                                         const FreeSpace& roomy, const GbPlannerParams& params,
                                         const PlanBudget& budget, Rng rng, PlanStats& stats);

}  // namespace spelunk::planners::gbplanner
