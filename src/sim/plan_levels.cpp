#include <algorithm>

#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

constexpr double kJitterShare = 0.2;  // of the pitch, each way

struct Layout {
  const LevelsParams& params;
  WorldPlan& plan;
  Rng rng;
  Relief relief;
  std::vector<Eigen::Vector2d> crossings;

  /// The same places on every level, so that shafts stand upright; the first is the start.
  void placeCrossings() {
    for (int row = 0; row < params.rows; ++row)
      for (int column = 0; column < params.columns; ++column) {
        const double x = params.pitch_x_m * (column + rng.uniform(-kJitterShare, kJitterShare));
        const double y = params.pitch_y_m * (row + rng.uniform(-kJitterShare, kJitterShare));
        crossings.push_back(plan.start.position.head<2>() + Eigen::Vector2d(x, y));
      }
    crossings.front() = plan.start.position.head<2>();
  }

  [[nodiscard]] Eigen::Vector3d floorOf(int crossing, int level) const {
    const Eigen::Vector2d& at = crossings[static_cast<std::size_t>(crossing)];
    return relief.lift(at.x(), at.y()) - Eigen::Vector3d(0.0, 0.0, level * params.level_drop_m);
  }

  [[nodiscard]] Edges neighbours() const {
    Edges edges;
    for (int row = 0; row < params.rows; ++row)
      for (int column = 0; column < params.columns; ++column) {
        const int place = row * params.columns + column;
        if (column + 1 < params.columns) edges.emplace_back(place, place + 1);
        if (row + 1 < params.rows) edges.emplace_back(place, place + params.columns);
      }
    return edges;
  }

  void addLevel(int level) {
    const Winding winding{params.wander_m,     params.width_min_m,  params.width_max_m,
                          params.height_min_m, params.height_max_m, 4.0};
    const int count = params.columns * params.rows;
    for (const auto& [a, b] : thinned(neighbours(), count, params.loop_share, rng))
      plan.passages.push_back(windingPassage(floorOf(a, level), floorOf(b, level), winding, rng));
  }

  /// Shafts stand at different crossings from level to level.
  void addShafts(int level) {
    std::vector<int> places;
    for (int tries = 0; tries < 100 && static_cast<int>(places.size()) < params.shafts; ++tries) {
      const int place = 1 + rng.below(params.columns * params.rows - 1);
      if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
    }
    for (const int place : places)
      plan.halls.push_back({floorOf(place, level + 1),
                            {params.shaft_m, params.shaft_m},
                            params.level_drop_m + params.height_min_m});
  }
};

}  // namespace

void layOut(const LevelsParams& params, WorldPlan& plan) {
  Layout layout{params,
                plan,
                Rng(plan.seed).fork("world/levels"),
                Relief(params.relief_m, 45.0, plan.start.position.head<2>(), plan.seed + 29),
                {}};
  layout.placeCrossings();
  for (int level = 0; level < params.levels; ++level) layout.addLevel(level);
  for (int level = 0; level + 1 < params.levels; ++level) layout.addShafts(level);
}

}  // namespace spelunk::sim
