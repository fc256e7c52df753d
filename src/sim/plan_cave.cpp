#include <algorithm>
#include <cmath>

#include "spelunk/sim/winding.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

struct Layout {
  const CaveParams& params;
  WorldPlan& plan;
  Rng rng;
  Relief relief;

  /// Chambers by dart throwing, the first at the start; they keep the least spacing in plan.
  void placeChambers() {
    addChamber(plan.start.position.head<2>());
    constexpr int kDarts = 3000;
    for (int dart = 0; dart < kDarts; ++dart) {
      const Eigen::Vector2d at(rng.uniform(0.0, params.size_x_m),
                               rng.uniform(0.0, params.size_y_m));
      const bool crowded =
          std::any_of(plan.chambers.begin(), plan.chambers.end(), [&](const Chamber& chamber) {
            return (chamber.floor.head<2>() - at).squaredNorm() <
                   params.chamber_spacing_m * params.chamber_spacing_m;
          });
      if (!crowded) addChamber(at);
    }
  }

  void addChamber(const Eigen::Vector2d& at) {
    const double size = rng.uniform();
    const double radius = params.chamber_radius_min_m +
                          (params.chamber_radius_max_m - params.chamber_radius_min_m) * size * size;
    const double stretch = rng.uniform(0.75, 1.25);
    const double height = std::max(params.height_min_m + 1.0, radius * rng.uniform(0.8, 1.3));
    plan.chambers.push_back(
        {relief.lift(at.x(), at.y()), {radius * stretch, radius / stretch}, height});
  }

  /// Neighbours: pairs whose circle of diameter holds no third chamber (the Gabriel graph) and
  /// whose slope can be flown.
  [[nodiscard]] Edges neighbours() const {
    Edges edges;
    const int count = static_cast<int>(plan.chambers.size());
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b)
        if (areNeighbours(a, b)) edges.emplace_back(a, b);
    return edges;
  }

  [[nodiscard]] const Eigen::Vector3d& floorOf(int chamber) const {
    return plan.chambers[static_cast<std::size_t>(chamber)].floor;
  }

  [[nodiscard]] bool areNeighbours(int a, int b) const {
    const Eigen::Vector3d gap = floorOf(b) - floorOf(a);
    const double run2 = gap.head<2>().squaredNorm();
    if (gap.z() * gap.z() > params.slope_max * params.slope_max * run2) return false;
    const Eigen::Vector2d middle = (floorOf(a) + floorOf(b)).head<2>() / 2.0;
    for (int c = 0; c < static_cast<int>(plan.chambers.size()); ++c)
      if (c != a && c != b && (floorOf(c).head<2>() - middle).squaredNorm() < run2 / 4.0)
        return false;
    return true;
  }

  void addPassages() {
    const int count = static_cast<int>(plan.chambers.size());
    const Winding winding{params.wander_m,     params.width_min_m,  params.width_max_m,
                          params.height_min_m, params.height_max_m, 2.5};
    for (const auto& [a, b] : thinned(neighbours(), count, params.loop_share, rng))
      plan.passages.push_back(windingPassage(floorOf(a), floorOf(b), winding, rng));
  }
};

}  // namespace

void layOut(const CaveParams& params, WorldPlan& plan) {
  Layout layout{params, plan, Rng(plan.seed).fork("world/cave"),
                Relief(params.relief_m, 38.0, plan.start.position.head<2>(), plan.seed + 17)};
  layout.placeChambers();
  layout.addPassages();
}

}  // namespace spelunk::sim
