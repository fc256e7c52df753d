#include "ray_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace spelunk::terrain {
namespace {

constexpr float kFraction = 65536.0F;  // cells as fixed point: the walk is exact integer work
constexpr int kFractionBits = 16;
constexpr float kNews_m = 0.001F;

}  // namespace

void lowerBoundsAlong(const Eigen::Vector3f& sensor, const Eigen::Vector3f& end,
                      const WindowGrid& grid, std::vector<float>& bounds,
                      std::vector<CellIndex>& changed) {
  const auto cell = static_cast<float>(grid.cell());
  const Eigen::Vector3f back = sensor - end;
  const float cells = std::max(std::fabs(back.x()), std::fabs(back.y())) / cell;
  if (!(back.z() > 0.0F) || cells < 1.0F) return;
  const float rise = back.z() / cells;
  const int steps = static_cast<int>(cells);
  const auto step_x = static_cast<std::int32_t>(back.x() / (cell * cells) * kFraction);
  const auto step_y = static_cast<std::int32_t>(back.y() / (cell * cells) * kFraction);
  auto x = static_cast<std::int32_t>(end.x() / cell * kFraction);
  auto y = static_cast<std::int32_t>(end.y() / cell * kFraction);
  float z = end.z();
  for (int i = 0; i < steps; ++i) {
    x += step_x;
    y += step_y;
    z += rise;
    const CellIndex at(grid.first().x() + (x >> kFractionBits),
                       grid.first().y() + (y >> kFractionBits));
    float& bound = bounds[grid.slotOf(at)];
    if (z >= bound - kNews_m) continue;
    changed.push_back(at);
    bound = z;
  }
}

Eigen::Vector3f exitOf(const ScanCells::Sector& sector, const Eigen::Vector3f& sensor,
                       float extent_m) {
  float distance = 1e6F;
  for (int axis = 0; axis < 2; ++axis) {
    const float d = sector.direction(axis);
    if (d > 0.0F) distance = std::min(distance, (0.9999F * extent_m - sensor(axis)) / d);
    if (d < 0.0F) distance = std::min(distance, (1e-4F * extent_m - sensor(axis)) / d);
  }
  Eigen::Vector3f exit = sensor;
  exit.head<2>() += distance * sector.direction;
  exit.z() -= distance * sector.fall;
  return exit;
}

}  // namespace spelunk::terrain
