#include <algorithm>

#include "spelunk/common/contract.h"
#include "spelunk/sim/world_kinds.h"

namespace spelunk::sim {
namespace {

constexpr int kDarts = 20000;         // a wall that fits nowhere ends the search
constexpr double kStartRoom_m = 2.0;  // around the start no wall stands

/// Whether two rectangles come nearer than `gap` on both axes.
bool areTooNear(const Pillar& a, const Pillar& b, double gap) {
  const Eigen::Vector2d between = (a.centre - b.centre).cwiseAbs() - 0.5 * (a.size + b.size);
  return (between.array() < gap).all();
}

/// A wall somewhere in the room, at least a gap from its sides.
Pillar drawnWall(const WallsParams& params, bool along_x, Rng& rng) {
  const double length = rng.uniform(params.length_min_m, params.length_max_m);
  Pillar wall;
  wall.size = along_x ? Eigen::Vector2d(length, params.thickness_m)
                      : Eigen::Vector2d(params.thickness_m, length);
  const Eigen::Vector2d room(params.size_x_m, params.size_y_m);
  const Eigen::Vector2d rim = 0.5 * wall.size + Eigen::Vector2d::Constant(params.gap_m);
  for (int axis = 0; axis < 2; ++axis)
    wall.centre[axis] = rng.uniform(rim[axis], std::max(rim[axis], room[axis] - rim[axis]));
  return wall;
}

}  // namespace

void layOut(const ShaftsParams& params, WorldPlan& plan) {
  const Eigen::Vector2d shaft(params.shaft_m, params.shaft_m);
  const Eigen::Vector3d far(params.distance_m, 0.0, 0.0);
  plan.halls.push_back({Eigen::Vector3d::Zero(), shaft, params.height_m});
  plan.halls.push_back({far, shaft, params.height_m});
  Passage passage;
  const Eigen::Vector3d aside(0.0, params.bend_m, 0.0);
  for (const Eigen::Vector3d& floor :
       {Eigen::Vector3d(0.0, 0.0, 0.0), aside, Eigen::Vector3d(far + aside), far})
    passage.stations.push_back({floor, params.passage_width_m, params.passage_height_m});
  plan.passages.push_back(passage);
}

void layOut(const WallsParams& params, WorldPlan& plan) {
  Rng rng = Rng(plan.seed).fork("world/walls");
  const Eigen::Vector2d size(params.size_x_m, params.size_y_m);
  plan.halls.push_back({{0.5 * size.x(), 0.5 * size.y(), 0.0}, size, params.height_m});
  const Pillar start{plan.start.position.head<2>(), Eigen::Vector2d::Constant(2.0 * kStartRoom_m)};
  for (int dart = 0; dart < kDarts && static_cast<int>(plan.pillars.size()) < params.walls;
       ++dart) {
    const Pillar wall = drawnWall(params, plan.pillars.size() % 2 == 0, rng);
    const bool fits = !areTooNear(wall, start, 0.0) &&
                      std::none_of(plan.pillars.begin(), plan.pillars.end(), [&](const Pillar& p) {
                        return areTooNear(wall, p, params.gap_m);
                      });
    if (fits) plan.pillars.push_back(wall);
  }
  if (static_cast<int>(plan.pillars.size()) < params.walls)
    throw OutsideError("world '" + plan.name + "': only " + std::to_string(plan.pillars.size()) +
                       " of " + std::to_string(params.walls) +
                       " walls fit; lower walls, length_max_m or gap_m");
}

}  // namespace spelunk::sim
