#pragma once

#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"

namespace spelunk::planners::baselines {

/// Parameters of the next-best-view planner (section "nbvp"). Symbols of Bircher 2016 in brackets.
struct NbvpParams {
  std::string samples = "explored";
  int max_vertices = 500;
  int give_up_vertices = 2500;
  double edge_length_min_m = 1.0;
  double edge_length_max_m = 6.0;
  double distance_weight = 0.1;
  double gain_min_m3 = 40.0;
  double cone_depth_m = 10.0;
  double closing_height_m = 2.0;
  double growth_m = 0.2;
  double eta_factor = 1.1;
  double tried_radius_m = 1.5;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("samples", samples, Bounds{},
          "where they are drawn: explored (known free volume) or box (the whole box around it)");
    field("max_vertices", max_vertices, Bounds{2, 100000},
          "the tree grows so large, and on while nothing is to be gained [N_max]", Audience::kUser);
    field("give_up_vertices", give_up_vertices, Bounds{2, 1000000},
          "nothing gained in a tree so large: explored [N_TOL]", Audience::kUser);
    field("edge_length_min_m", edge_length_min_m, Bounds{0.05, 50.0},
          "shorter edges are not worth a node; what is left of one is executed with the next");
    field("edge_length_max_m", edge_length_max_m, Bounds{0.2, 50.0}, "longest edge of the tree");
    field("distance_weight", distance_weight, Bounds{0.0, 10.0},
          "how much distance along a branch costs, 1/m [lambda]", Audience::kUser);
    field("gain_min_m3", gain_min_m3, Bounds{0.0, 1e5},
          "a place that sees less unknown volume sees nothing", Audience::kUser);
    field("cone_depth_m", cone_depth_m, Bounds{0.1, 1000.0},
          "a ray counts up to here beyond its first unknown voxel");
    field("closing_height_m", closing_height_m, Bounds{0.0, 10.0},
          "gaps between sensor rows this high hold nothing to explore");
    field("growth_m", growth_m, Bounds{0.0, 5.0},
          "obstacles are this much thicker for the rays of a gain");
    field("eta_factor", eta_factor, Bounds{1.0, 5.0}, "travel time is length / speed times this");
    field("tried_radius_m", tried_radius_m, Bounds{0.1, 50.0},
          "edges that end this near to a failed one's end are the same");
  }
  /// With a least gain that the robot's sensors can pass, see passableThreshold().
  [[nodiscard]] NbvpParams resolvedFor(const RobotModel& robot) const;
  /// Rules between fields, for the tree's problem list.
  [[nodiscard]] std::vector<std::string> problems() const;
  /// The same between these parameters, the robot and the map's resolution.
  [[nodiscard]] std::vector<std::string> problemsFor(const RobotModel& robot,
                                                     double resolution_m) const;
};

}  // namespace spelunk::planners::baselines
