#pragma once

#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/navigation/navigator.h"

namespace spelunk::planners::baselines {

/// Parameters of the frontier planners (sections "frontier_nearest", "frontier_utility" and
/// "frontier_rrt_star").
struct FrontierPlannerParams {
  std::string way_method = "adaptive";
  double range_m = 4.0;
  double sample_spacing_m = 1.0;
  int candidates = 10;
  double gain_min_m3 = 2.0;
  int frontier_voxels_min = 20;
  double closing_height_m = 1.4;
  double growth_m = 0.2;
  double safe_distance_m = 0.2;
  int iterations = 10000;
  double eta_factor = 1.2;
  double tried_radius_m = 1.5;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("way_method", way_method, Bounds{}, "how ways are planned: see navigation.method");
    field("range_m", range_m, Bounds{0.0, 500.0},
          "length of the rays of a gain; 0: as far as the sensors see without gaps",
          Audience::kUser);
    field("sample_spacing_m", sample_spacing_m, Bounds{0.1, 20.0},
          "candidates are at least this far apart");
    field("candidates", candidates, Bounds{1, 1000}, "of which the best is flown to");
    field("gain_min_m3", gain_min_m3, Bounds{0.0, 1e5},
          "a place that sees less unknown volume is not worth flying to", Audience::kUser);
    field("frontier_voxels_min", frontier_voxels_min, Bounds{1, 100000},
          "fewer frontier voxels within a metre are no target");
    field("closing_height_m", closing_height_m, Bounds{0.0, 10.0},
          "gaps between sensor rows this high hold nothing to explore");
    field("growth_m", growth_m, Bounds{0.0, 5.0},
          "obstacles are this much thicker for the rays of a gain");
    field("safe_distance_m", safe_distance_m, Bounds{0.0, 5.0},
          "navigation keeps this from obstacles where it can");
    field("iterations", iterations, Bounds{10, 1000000}, "of a navigation query");
    field("eta_factor", eta_factor, Bounds{1.0, 5.0}, "travel time is length / speed times this");
    field("tried_radius_m", tried_radius_m, Bounds{0.1, 50.0},
          "targets this near to a failed one are the same");
  }
  /// With range_m 0: that of denseRange(robot). Else as is.
  [[nodiscard]] FrontierPlannerParams resolvedFor(const RobotModel& robot) const;

  /// Rules between fields, for the tree's problem list.
  [[nodiscard]] std::vector<std::string> problems() const;
  /// The same between these parameters, the robot and the map's resolution.
  [[nodiscard]] std::vector<std::string> problemsFor(const RobotModel& robot,
                                                     double resolution_m) const;

  /// The defaults of "frontier_nearest" and "frontier_rrt_star"; those of a new struct are
  /// "frontier_utility"'s.
  [[nodiscard]] static FrontierPlannerParams forNearest();
  [[nodiscard]] static FrontierPlannerParams forRrtStar();

  /// What navigation home is to use: the same, but RRT-Connect in place of RRT*, for a way home is
  /// measured with every plan.
  [[nodiscard]] navigation::NavigationParams homeNavigation() const;

  /// What navigation to frontiers is to use.
  [[nodiscard]] navigation::NavigationParams navigation() const;
};

}  // namespace spelunk::planners::baselines
