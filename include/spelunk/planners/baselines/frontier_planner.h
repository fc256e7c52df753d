#pragma once

#include <memory>
#include <optional>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/baselines/frontier_planner_params.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/frontier_view.h"
#include "spelunk/planners/shared/remembering.h"
#include "spelunk/planners/shared/trail_home.h"
#include "spelunk/planners/shared/tried_targets.h"
#include "spelunk/planners/shared/visits.h"

namespace spelunk::planners::baselines {

/// What makes one frontier better than another.
enum class Preference {
  kNearest,  ///< The shortest way to it: Yamauchi, A frontier-based approach for autonomous
             ///< exploration, CIRA 1997. "FE" in Akbari 2021, section VIII-B; with ways by RRT*
             ///< the "FrontierPlanner" of Dang 2020, section 5.
  kUtility   ///< Most unknown volume seen from it a second of travel: Dai et al., Fast
             ///< frontier-based information-driven autonomous exploration with an MAV, ICRA 2020.
             ///< "UE".
};

/// What a frontier planner has learnt.
struct FrontierMemory {
  struct Target {
    Eigen::Vector3d voxel = Eigen::Vector3d::Zero();
    Path path;
    double gain_m3 = 0.0;
  };

  explicit FrontierMemory(double tried_radius_m) : tried(tried_radius_m) {}

  TriedTargets tried;
  Visits visits;
  TrailHome trail;
  std::optional<Target> target;
  ReportedPath last;
};

/// Frontier-based exploration for robots that fly: every frontier voxel of the whole map is a
/// possible target, there is no graph. Ways by navigation through known free space. Frontier
/// voxels, places beside them and gains as Informed Exploration has them, so that the comparison is
/// about the choice alone. Differs from the originals: candidates are a few frontier voxels at a
/// distance from each other, the straight-nearest ones (kNearest) or drawn at random (kUtility);
/// the way to each is planned.
///
/// best_gain and gain_threshold of the stats are cubic metres of unknown space, 0 for kNearest.
/// planHome(): by RRT-Connect or along the trail, whichever is shorter.
class FrontierPlanner final : public Remembering<FrontierMemory> {
 public:
  FrontierPlanner(const FrontierPlannerParams& params, Preference preference,
                  const RobotModel& robot, double resolution_m);

  /// Layers "search" (tree of the newest search) and "samples" (candidates, by score).
  [[nodiscard]] PlannerGraph graph() const override;
  /// There is no graph to take up.
  void restore(const PlannerGraph& graph) override;

 private:
  using Target = FrontierMemory::Target;
  struct Search;

  PlanResult doPlan(const PlanRequest& request) override;
  PlanResult doPlanHome(const PlanRequest& request) override;

  FrontierPlannerParams params_;
  Preference preference_;
  RobotModel robot_;
  FrontierView view_;
  navigation::Navigator navigator_;
  navigation::Navigator home_navigator_;
  map::ConfigurationSpace boxes_;
  // Of the newest plan, taken or not; to be looked at.
  GraphLayer search_layer_;
  GraphLayer samples_layer_;
};

}  // namespace spelunk::planners::baselines
