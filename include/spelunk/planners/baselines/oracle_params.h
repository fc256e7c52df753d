#pragma once

#include <string>
#include <vector>

#include "spelunk/common/params.h"

namespace spelunk::planners::baselines {

/// Parameters of the planner that is given its tour (section "oracle").
struct OracleParams {
  std::string tour;
  double look_ahead_m = 30.0;
  double reached_m = 1.5;
  double shortcut_length_max_m = 3.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("tour", tour, Bounds{}, "file of the tour: x_m,y_m,z_m in lines, in the map's frame",
          Audience::kUser);
    field("look_ahead_m", look_ahead_m, Bounds{1.0, 1000.0}, "longest part of the tour proposed");
    field("reached_m", reached_m, Bounds{0.1, 20.0}, "a point of the tour counts as reached");
    field("shortcut_length_max_m", shortcut_length_max_m, Bounds{0.0, 100.0},
          "points are left out where a straight free way this long leads past them");
  }
};

}  // namespace spelunk::planners::baselines
