#pragma once

#include <memory>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/map/credible_map.h"
#include "spelunk/map/kept_window.h"
#include "spelunk/map/volumetric_gain.h"
#include "spelunk/planners/baselines/nbvp_params.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/remembering.h"
#include "spelunk/planners/shared/trail_home.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::baselines {

/// What NBVP has learnt.
struct NbvpMemory {
  explicit NbvpMemory(double tried_radius_m) : tried(tried_radius_m) {}

  TrailHome trail;
  TriedTargets tried;
  Path branch;              ///< The best branch of the newest tree, from its root on.
  double executed_m = 0.0;  ///< Of it, that was proposed as a path.
  ReportedPath last;
};

/// NBVP: Bircher, Kamel, Alexis, Oleynikova, Siegwart: Receding horizon "next-best-view" planner
/// for 3D exploration, ICRA 2016, Algorithm 1, as Dang 2020, section 5, compares with it. A random
/// tree grows from the robot through all explored free space; the branch that sees most unknown
/// volume at least cost is best; its first edge is executed, the rest of it begins the next tree.
/// For robots that fly, and for robots with legs above ground they can walk on.
///
/// Differs from the paper: samples are drawn from the known free volume, so that none is lost, and
/// only on demand from the whole box; where a sensor sees all around, a node looks along its edge
/// instead of somewhere at random; unknown volume is counted as GBPlanner counts it here (cones in
/// the credible map), so that the comparison is about the search; a branch counts only if there is
/// time for it and the way home; the next plan begins before the robot has come to the end of an
/// edge, and what is then left of that edge is executed with the next one. The cost of a node is
/// the length of its whole branch.
///
/// best_gain of the stats is that of the best branch, gain_threshold the volume below which a place
/// sees nothing; m3. planHome(): the shortest way along the robot's own trail and its short cuts,
/// for the paper has none.
class NbvpPlanner final : public Remembering<NbvpMemory> {
 public:
  /// `resolution_m`: of the maps it will be asked on.
  NbvpPlanner(const NbvpParams& params, const RobotModel& robot, double resolution_m);

  /// Layers "tree" (the newest; gains of branches) and "trail".
  [[nodiscard]] PlannerGraph graph() const override;
  /// Takes up "trail"; trees are not kept.
  void restore(const PlannerGraph& graph) override;

 private:
  struct Search;

  PlanResult doPlan(const PlanRequest& request) override;
  PlanResult doPlanHome(const PlanRequest& request) override;

  NbvpParams params_;
  RobotModel robot_;
  map::GainEvaluator evaluator_;
  map::CredibleMap credible_;
  map::KeptWindow window_;  ///< Of the credible map.
  map::ConfigurationSpace boxes_;
  GraphLayer tree_layer_;  ///< Of the newest plan, taken or not; to be looked at.
};

}  // namespace spelunk::planners::baselines
