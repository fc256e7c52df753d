#pragma once

#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"

namespace spelunk::planners::informed {

/// Parameters of Informed Exploration (section "informed"). Symbols of Akbari 2021 in brackets.
struct InformedParams {
  static constexpr double kPaperRange_m = 4.0;  ///< What the other defaults were made for.

  double range_m = 0.0;
  double sample_spacing_m = 1.0;
  int samples_a_vertex = 4;
  int ranked_vertices = 3;
  double ranked_rate = 0.6;
  double end_weight = 1.0;
  double way_weight = 0.2;
  double gain_factor = 1.0;
  double length_decay = 0.5;
  double clearance_weight_void = 0.2;
  double clearance_weight_branch = 0.6;
  double clearance_max_m = 2.5;
  double entropy_free_bits = 0.0;
  double entropy_occupied_bits = 0.0;
  double gain_min_m3 = 2.0;
  int frontier_voxels_min = 20;
  double branch_distance_m = 3.0;
  double closing_height_m = 1.4;
  double growth_m = 0.2;
  double safe_distance_m = 0.2;
  int iterations = 3000;
  double eta_factor = 1.1;
  double tried_radius_m = 1.5;
  double visited_radius_m = 0.0;
  double shortcut_length_max_m = 8.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field(
        "range_m", range_m, Bounds{0.0, 100.0},
        "spacing of vertices, half their boxes and length of the rays of a gain; 0: as far as the "
        "sensors see without gaps, with what is meant for 4 m scaled to it [d_max]",
        Audience::kUser);
    field("sample_spacing_m", sample_spacing_m, Bounds{0.1, 20.0},
          "frontier samples are at least this far apart [d_s]");
    field("samples_a_vertex", samples_a_vertex, Bounds{1, 1000},
          "frontier samples drawn from each neighbouring vertex");
    field("ranked_vertices", ranked_vertices, Bounds{1, 100},
          "nearest unexplored vertices looked at together when the neighbourhood is done");
    field("ranked_rate", ranked_rate, Bounds{0.05, 1.0},
          "share of samples that each farther one of them gets [f_s]");
    field("end_weight", end_weight, Bounds{0.0, 100.0}, "entropy at the sample counts [alpha]");
    field("way_weight", way_weight, Bounds{0.0, 100.0}, "entropy along the way counts [beta]");
    field("gain_factor", gain_factor, Bounds{1e-6, 1e6}, "of the whole utility [delta]");
    field("length_decay", length_decay, Bounds{0.0, 10.0},
          "how fast utility falls with the length of the way, 1/m [gamma]", Audience::kUser);
    field("clearance_weight_void", clearance_weight_void, Bounds{0.0, 10.0},
          "distance to obstacles counts in wide areas [zeta]");
    field("clearance_weight_branch", clearance_weight_branch, Bounds{0.0, 10.0},
          "distance to obstacles counts in narrow passages [zeta]");
    field("clearance_max_m", clearance_max_m, Bounds{0.2, 10.0}, "obstacles farther off are alike");
    field("entropy_free_bits", entropy_free_bits, Bounds{0.0, 1.0},
          "of a free voxel; 0.53 is what the map's limits leave, 0 what another look can gain");
    field("entropy_occupied_bits", entropy_occupied_bits, Bounds{0.0, 1.0},
          "the same of an occupied voxel, 0.19");
    field("gain_min_m3", gain_min_m3, Bounds{0.0, 1e5},
          "a sample that would see less unknown volume is not worth flying to", Audience::kUser);
    field("frontier_voxels_min", frontier_voxels_min, Bounds{1, 100000},
          "a vertex with fewer frontier voxels is explored");
    field("branch_distance_m", branch_distance_m, Bounds{0.2, 50.0},
          "obstacles this near on two axes make a branch");
    field("closing_height_m", closing_height_m, Bounds{0.0, 10.0},
          "gaps between sensor rows this high hold nothing to explore");
    field("growth_m", growth_m, Bounds{0.0, 5.0},
          "obstacles are this much thicker for the rays of a gain");
    field("safe_distance_m", safe_distance_m, Bounds{0.0, 5.0},
          "navigation keeps this from obstacles where it can");
    field("iterations", iterations, Bounds{10, 1000000}, "of a navigation query to a sample");
    field("eta_factor", eta_factor, Bounds{1.0, 5.0}, "travel time is length / speed times this");
    field("tried_radius_m", tried_radius_m, Bounds{0.1, 50.0},
          "targets this near to a failed one are the same");
    field("visited_radius_m", visited_radius_m, Bounds{0.0, 10.0},
          "places this near to the trail have shown what they can; 0: 1 m with range_m 0 and a "
          "sensor that looks all round, else any may show more");
    field("shortcut_length_max_m", shortcut_length_max_m, Bounds{0.5, 200.0},
          "longest straight shortcut of a way along the graph");
  }

  /// With range_m 0: the distance up to which the rows of the robot's best sensor are no farther
  /// apart than its box is high, so that a place there is known as a whole; sample_spacing_m,
  /// length_decay and gain_min_m3, which are meant for the paper's 4 m, are scaled to it. Else as
  /// is.
  [[nodiscard]] InformedParams resolvedFor(const RobotModel& robot) const;

  /// Rules between fields, for the tree's problem list.
  [[nodiscard]] std::vector<std::string> problems() const;
  /// The same between these parameters, the robot and the map's resolution.
  [[nodiscard]] std::vector<std::string> problemsFor(const RobotModel& robot,
                                                     double resolution_m) const;
};

}  // namespace spelunk::planners::informed
