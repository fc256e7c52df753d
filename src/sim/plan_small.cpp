#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {

void layOut(const RoomParams& params, WorldPlan& plan) {
  plan.halls.push_back({{0.0, 0.0, 0.0}, {params.size_x_m, params.size_y_m}, params.height_m});
  if (params.pillar_m > 0.0)
    plan.pillars.push_back(
        {{params.size_x_m / 8.0, -params.size_y_m / 12.0}, {params.pillar_m, params.pillar_m}});
  if (params.alcove_m <= 0.0) return;
  const double overlap = 1.0;
  plan.halls.push_back(
      {{params.size_x_m / 4.0, params.size_y_m / 2.0 + (params.alcove_m - overlap) / 2.0, 0.0},
       {params.alcove_m, params.alcove_m + overlap},
       0.8 * params.height_m});
}

void layOut(const MazeParams& params, WorldPlan& plan) {
  Rng rng = Rng(plan.seed).fork("world/maze");
  Edges all;
  for (int row = 0; row < params.rows; ++row) {
    for (int column = 0; column < params.columns; ++column) {
      const int place = row * params.columns + column;
      if (column + 1 < params.columns) all.emplace_back(place, place + 1);
      if (row + 1 < params.rows) all.emplace_back(place, place + params.columns);
    }
  }
  const auto at = [&](int place) {
    return Eigen::Vector3d(params.pitch_m * (place % params.columns),
                           params.pitch_m * (place / params.columns), 0.0);
  };
  for (const auto& [a, b] : thinned(all, params.rows * params.columns, params.loop_share, rng))
    plan.passages.push_back(
        {{{at(a), params.width_m, params.height_m}, {at(b), params.width_m, params.height_m}}});
}

}  // namespace spelunk::sim
