#pragma once

#include <memory>
#include <optional>
#include <string>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/map/credible_map.h"
#include "spelunk/map/kept_window.h"
#include "spelunk/map/presumed_ways.h"
#include "spelunk/map/volumetric_gain.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"
#include "spelunk/planners/gbplanner/local_search.h"
#include "spelunk/planners/shared/global_graph.h"
#include "spelunk/planners/shared/remembering.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::gbplanner {

/// What GBPlanner has learnt.
struct GbMemory {
  /// The newest path proposed by plan().
  struct Proposal {
    PathKind kind = PathKind::kLocal;
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< The vertex it was chosen for.
    Eigen::Vector3d end = Eigen::Vector3d::Zero();     ///< Where it ends: it may have been cut.
  };

  explicit GbMemory(const GbPlannerParams& params);

  GlobalGraph global;
  TriedTargets tried;
  std::optional<Proposal> proposal;
  ReportedPath last;
  double trail_known_until_s;
  std::shared_ptr<const map::FrozenMap> checked_map;
  std::uint64_t checked_zones = 0;       ///< Their revision.
  std::vector<map::ClosedPlace> closed;  ///< Where presumed ways turned out to lead nowhere.
};

/// GBPlanner for aerial robots: Dang, Tranzatto, Khattak, Mascarich, Alexis, Hutter: Graph-based
/// Subterranean Exploration Path Planning using Aerial and Legged Robots. Journal of Field Robotics
/// 37(8), 2020, sections 4.1, 4.2 and 4.4.
///
/// plan(): the local planner; on local completion the global planner, by itself. best_gain and
/// gain_threshold of the stats are discounted m3 (eq. 1 without the similarity factor).
/// planHome(): the shortest checked way in the global graph.
class GbPlanner final : public Remembering<GbMemory> {
 public:
  /// `resolution_m`: of the maps it will be asked on.
  GbPlanner(const GbPlannerParams& params, const RobotModel& robot, double resolution_m);

  [[nodiscard]] PlannerGraph graph() const override;
  void restore(const PlannerGraph& graph) override;

 private:
  struct Search;

  PlanResult doPlan(const PlanRequest& request) override;
  PlanResult doPlanHome(const PlanRequest& request) override;

  GbPlannerParams params_;
  RobotModel robot_;
  map::GainEvaluator evaluator_;
  map::CredibleMap credible_;
  map::KeptWindow window_;  ///< Of the credible map.
  map::ConfigurationSpace body_;
  map::ConfigurationSpace roomy_;  ///< With the safety margin.
  GraphLayer local_layer_;         ///< Of the newest plan, taken or not; to be looked at.
};

}  // namespace spelunk::planners::gbplanner
