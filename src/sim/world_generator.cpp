#include "spelunk/sim/world_generator.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/sim/rock_field.h"
#include "spelunk/sim/surface_nets.h"

namespace spelunk::sim {
namespace {

constexpr int kChunk = 8;  ///< Grid points along an edge of the chunks that are sampled together.
constexpr double kStartClearance_m = 0.6;

ScalarGrid emptyGrid(const RockField& field, double cell_m) {
  const AxisAlignedBox box = field.bounds();
  ScalarGrid grid;
  grid.cell_m = cell_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = std::floor(box.min[axis] / cell_m) - 1.0;
    grid.origin[axis] = first * cell_m;
    grid.size[axis] = static_cast<int>(std::ceil(box.max[axis] / cell_m) + 2.0 - first);
  }
  grid.values.assign(grid.offsetOf(0, 0, grid.size.z()), static_cast<float>(cell_m));
  return grid;
}

void sampleChunk(const RockField& field, const Eigen::Vector3i& first, ScalarGrid& grid) {
  const Eigen::Vector3i last =
      (first + Eigen::Vector3i::Constant(kChunk - 1)).cwiseMin(grid.size - Eigen::Vector3i::Ones());
  const RockField::Selection near = field.select(
      {grid.pointAt(first.x(), first.y(), first.z()), grid.pointAt(last.x(), last.y(), last.z())});
  if (near.isEmpty()) return;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        grid.values[grid.offsetOf(x, y, z)] =
            static_cast<float>(std::min(field.at(grid.pointAt(x, y, z), near), 1e3));
}

ScalarGrid sampled(const RockField& field, double cell_m) {
  ScalarGrid grid = emptyGrid(field, cell_m);
  for (int z = 0; z < grid.size.z(); z += kChunk)
    for (int y = 0; y < grid.size.y(); y += kChunk)
      for (int x = 0; x < grid.size.x(); x += kChunk) sampleChunk(field, {x, y, z}, grid);
  return grid;
}

void requireFreeStart(const WorldPlan& plan, const RockField& field) {
  if (field.at(plan.start.position) <= -kStartClearance_m) return;
  throw OutsideError("world '" + plan.name + "': less than " + std::to_string(kStartClearance_m) +
                     " m of free space around its start; move start.x_m, start.y_m, start.z_m");
}

}  // namespace

WorldMesh meshOf(const WorldPlan& plan) {
  require(!plan.passages.empty() || !plan.chambers.empty() || !plan.halls.empty(),
          "meshOf: the plan holds no space");
  const RockField field(plan);
  requireFreeStart(plan, field);
  ScalarGrid grid = sampled(field, plan.cell_m);
  makeManifold(grid);
  keepConnected(grid, plan.start.position);
  WorldMesh mesh = surfaceOf(grid);
  mesh.name = plan.name;
  mesh.start = plan.start;
  return mesh;
}

WorldMesh generateWorld(const std::string& description_path) {
  return meshOf(planWorld(description_path));
}

}  // namespace spelunk::sim
