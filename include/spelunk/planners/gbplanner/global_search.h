#pragma once

#include <functional>
#include <optional>
#include <string>

#include "spelunk/map/presumed_ways.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"
#include "spelunk/planners/shared/global_graph.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::gbplanner {

/// What the global planner is asked with.
struct GlobalQuery {
  graph::VertexId current{};
  double remaining_s = 0.0;  ///< RET
  double speed_mps = 1.0;
  double frontier_gain_m3 = 0.0;  ///< Frontiers below are not gone to.
  /// VolumetricGain at a place, newly computed; m3.
  std::function<double(const Eigen::Vector3d&)> gain_at;
  const map::PresumedWays* presumed = nullptr;  ///< From the current place; none: not used.
};

/// A way to a frontier, or why there is none.
struct GlobalPlan {
  graph::Polyline path;  ///< Empty if no frontier can be gone to, or on presumed ways only.
  std::optional<Eigen::Vector3d> target;
  double saved_m = 0.0;  ///< Above 0: the target is better gone to on the presumed way.
  double gain_m3 = 0.0;
  double best = 0.0;  ///< Eq. (2) of the chosen frontier.
  /// Open frontiers of the full frontier_gain_m3 that eq. (3) rules out, and that no free path
  /// leads to.
  int out_of_budget = 0;
  int unreachable = 0;
};

/// The global planner (Dang 2020, Alg. 3), ImprovePath left to the caller: the frontier that
/// maximises eq. (2), on a path checked in `space`. The gain of the best one is computed anew
/// before it is believed; if it fell below frontier_gain_m3 or much of it is gone, the next best
/// is looked at; below kMinorShare of it the frontier is dropped. Frontiers near a tried target are
/// closed with the reason. Beyond the paper: where a presumed way is shorter by presumed_saving_m,
/// its length counts, and no path is given.
[[nodiscard]] GlobalPlan planGlobally(GlobalGraph& global, const GlobalQuery& query,
                                      const FreeSpace& space, const TriedTargets& tried,
                                      const GbPlannerParams& params);

}  // namespace spelunk::planners::gbplanner
