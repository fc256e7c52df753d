#pragma once

#include <optional>
#include <vector>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/planners/gbplanner/local_graph.h"
#include "spelunk/planners/gbplanner/plan_view.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::gbplanner {

/// What earlier plans leave to this one.
struct LocalContext {
  const TriedTargets& tried;
  std::optional<Eigen::Vector3d> previous_target;  ///< Of the path being flown; none: free choice.
  double way_home_m = 0.0;                         ///< From the start of the plan.
};

/// A branch of the local graph with something to see at its end: at least kMinorShare of
/// frontier_gain_m3.
struct PrincipalPath {
  graph::Polyline path;
  double gain_m3 = 0.0;  ///< At its last vertex.
};

/// What one run of the local planner found.
struct LocalPlan {
  LocalGraph local;
  std::vector<double> gains_m3;  ///< One a vertex.
  graph::Polyline best;          ///< Not improved yet; empty on local completion.
  double best_gain_m3 = 0.0;     ///< Discounted gain of the best path; its own if none qualified.
  bool is_over_budget = false;  ///< A path qualified, but there is no time for it and the way home.
  std::vector<PrincipalPath> principals;
};

/// The local planner (Dang 2020, Alg. 1) from a free `root`, ImprovePath left to the caller.
/// Local completion: no path's discounted gain, eq. (1), reaches gain_threshold_m3.
/// Differs from the paper: the similarity factor of eq. (1) ranks paths but does not decide
/// completion, else a turn at the end of a gallery would look like there were nothing left; a path
/// to the previous target is favoured by `commitment`, so that new samples alone do not change
/// the plan.
[[nodiscard]] LocalPlan planLocally(const PlanRequest& request, PlanView& view,
                                    const Eigen::Vector3d& root, const LocalContext& context,
                                    const RobotModel& robot, const GbPlannerParams& params,
                                    PlanStats& stats);

}  // namespace spelunk::planners::gbplanner
