#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"

namespace spelunk::planners::gbplanner {

/// Once nothing reaches the thresholds g_e and frontier_gain_m3, places that promise this share of
/// them are good enough.
inline constexpr double kMinorShare = 0.25;

/// Parameters of GBPlanner (section "gbplanner"). Symbols of Dang 2020 in brackets.
struct GbPlannerParams {
  Eigen::Vector3d local_box_m{110.0, 110.0, 6.0};
  int max_vertices = 500;
  int max_edges = 5000;
  double edge_length_min_m = 1.0;
  double edge_length_max_m = 6.0;
  double connection_radius_m = 5.0;
  int connections_max = 10;
  double gain_threshold_m3 = 800.0;
  double similarity_weight = 0.012;
  double distance_weight = 0.02;
  double direction_window_s = 6.0;
  double commitment = 1.5;
  double local_length_max_m = 24.0;
  double path_spacing_m = 1.0;
  bool count_once = false;
  bool count_cones = true;
  double cone_depth_m = 10.0;
  double closing_height_m = 2.0;
  double growth_m = 0.2;
  Eigen::Vector3d safety_margin_m{0.1, 0.1, 0.3};
  double tightness_cost = 2.0;
  double frontier_gain_m3 = 150.0;
  double frontier_spacing_m = 3.0;
  double cluster_distance_m = 2.0;
  double global_distance_weight = 0.02;
  double global_radius_m = 4.0;
  double presumed_saving_m = 30.0;
  double eta_factor = 1.0;
  double tried_radius_m = 3.0;
  double visited_radius_m = 0.0;
  double shortcut_length_max_m = 12.0;
  double prune_length_m = 0.5;
  double inflation_radius_m = 2.5;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("local_box_m", local_box_m, Bounds{2.0, 200.0},
          "full extents of the sliding local box [D_L]", Audience::kUser);
    field("max_vertices", max_vertices, Bounds{2, 100000}, "vertices of a local graph [N_V,max]");
    field("max_edges", max_edges, Bounds{1, 1000000}, "edges of a local graph [N_E,max]");
    field("edge_length_min_m", edge_length_min_m, Bounds{0.0, 5.0},
          "samples nearer to a vertex are not worth one");
    field("edge_length_max_m", edge_length_max_m, Bounds{0.2, 50.0},
          "a farther sample is pulled to this distance");
    field("connection_radius_m", connection_radius_m, Bounds{0.2, 50.0},
          "a new vertex is joined to those within it [delta]");
    field("connections_max", connections_max, Bounds{1, 1000},
          "nearest vertices tried within that radius");
    field("gain_threshold_m3", gain_threshold_m3, Bounds{0.0, 1e6},
          "a path whose exploration gain is lower is not worth flying [g_e]", Audience::kUser);
    field("similarity_weight", similarity_weight, Bounds{0.0, 10.0},
          "how much leaving the exploring direction costs [gamma_S]");
    field("distance_weight", distance_weight, Bounds{0.0, 10.0},
          "how much distance along a path costs [gamma_D]");
    field("direction_window_s", direction_window_s, Bounds{0.5, 120.0},
          "the exploring direction is averaged over it");
    field("commitment", commitment, Bounds{1.0, 10.0},
          "a path to the previous target counts this many times");
    field("local_length_max_m", local_length_max_m, Bounds{1.0, 500.0},
          "longer local paths are cut");
    field("path_spacing_m", path_spacing_m, Bounds{0.1, 10.0},
          "spacing of points compared by time warping");
    field("count_once", count_once, Bounds{},
          "count the gain of a path at its best vertex instead of the sum over all");
    field("count_cones", count_cones, Bounds{},
          "a ray counts the volume of its cone instead of its voxels");
    field("cone_depth_m", cone_depth_m, Bounds{0.1, 1000.0},
          "a cone counts up to here beyond its first unknown voxel");
    field("closing_height_m", closing_height_m, Bounds{0.0, 10.0},
          "gaps between sensor rows this high hold nothing to explore");
    field("growth_m", growth_m, Bounds{0.0, 5.0},
          "obstacles are this much thicker for the rays of a gain");
    field("safety_margin_m", safety_margin_m, Bounds{0.0, 2.0}, "room wanted on each side");
    field("tightness_cost", tightness_cost, Bounds{1.0, 100.0},
          "ways without that room count as this many times longer");
    field("frontier_gain_m3", frontier_gain_m3, Bounds{0.0, 1e6},
          "volumetric gain that makes a leaf a frontier", Audience::kUser);
    field("frontier_spacing_m", frontier_spacing_m, Bounds{0.1, 50.0},
          "frontiers nearer to each other are one");
    field("cluster_distance_m", cluster_distance_m, Bounds{0.1, 50.0},
          "mean distance of paths that are one branch");
    field("global_distance_weight", global_distance_weight, Bounds{0.0, 10.0},
          "how much distance to a frontier costs [epsilon_D]", Audience::kUser);
    field("global_radius_m", global_radius_m, Bounds{0.5, 50.0},
          "new global vertices are joined to those within it");
    field("presumed_saving_m", presumed_saving_m, Bounds{0.0, 1e6},
          "a way through gaps of the map is flown if it is shorter by this");
    field("eta_factor", eta_factor, Bounds{1.0, 5.0},
          "travel time is length / speed times this; the mission adds its own pessimism");
    field("tried_radius_m", tried_radius_m, Bounds{0.1, 50.0},
          "targets this near to a failed one are the same");
    field("visited_radius_m", visited_radius_m, Bounds{0.0, 10.0},
          "places this near to the trail have shown what they can; 0: any may show more");
    field("shortcut_length_max_m", shortcut_length_max_m, Bounds{0.5, 200.0},
          "longest straight shortcut of a path");
    field("prune_length_m", prune_length_m, Bounds{0.0, 5.0}, "shorter edges are pruned");
    field("inflation_radius_m", inflation_radius_m, Bounds{0.2, 20.0},
          "obstacles this near shape the room around an edge");
  }

  /// With thresholds of gain that the robot's sensors can pass, see passableThreshold().
  [[nodiscard]] GbPlannerParams resolvedFor(const RobotModel& robot) const;
  /// Rules between fields, for the tree's problem list.
  [[nodiscard]] std::vector<std::string> problems() const;
  /// The same between these parameters, the robot and the map's resolution.
  [[nodiscard]] std::vector<std::string> problemsFor(const RobotModel& robot,
                                                     double resolution_m) const;
};

}  // namespace spelunk::planners::gbplanner
