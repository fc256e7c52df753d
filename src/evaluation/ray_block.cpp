#include "ray_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eight_walks.h"

namespace spelunk::evaluation {
namespace {

/// One axis of a voxel walk (Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing,
/// Eurographics 1987); lengths in voxels.
struct Axis {
  double next = std::numeric_limits<double>::infinity();  ///< Length at which it steps next.
  double spacing = std::numeric_limits<double>::infinity();
  double exit = std::numeric_limits<double>::infinity();  ///< Length at which the grid ends.
  std::ptrdiff_t stride = 0;                              ///< Change of the grid's offset.
};

Axis axisOf(double from, double direction, int size, std::ptrdiff_t stride) {
  Axis axis;
  if (direction == 0.0) return axis;
  const bool is_up = direction > 0.0;
  const double cell = std::floor(from);
  axis.spacing = std::abs(1.0 / direction);
  axis.next = (is_up ? cell + 1.0 - from : from - cell) * axis.spacing;
  axis.exit = (is_up ? size - from : from) * axis.spacing;
  axis.stride = is_up ? stride : -stride;
  return axis;
}

std::size_t walk(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length,
                 VoxelGrid& grid) {
  const Eigen::Vector3i& size = grid.size();
  const std::ptrdiff_t row = size.x();
  Axis x = axisOf(from.x(), direction.x(), size.x(), 1);
  Axis y = axisOf(from.y(), direction.y(), size.y(), row);
  Axis z = axisOf(from.z(), direction.z(), size.z(), row * size.y());
  const double limit = std::min({length, x.exit - kInside, y.exit - kInside, z.exit - kInside});
  auto offset = static_cast<std::ptrdiff_t>(grid.offsetOf(from.array().floor().cast<int>()));
  std::size_t found = 0;
  const auto leave = [&](Axis& axis) {
    found += grid.set(static_cast<std::size_t>(offset)) ? 1 : 0;
    if (axis.next > limit) return false;
    offset += axis.stride;
    axis.next += axis.spacing;
    return true;
  };
  for (bool is_going = true; is_going;) {
    if (x.next < y.next)
      is_going = leave(x.next < z.next ? x : z);
    else
      is_going = leave(y.next < z.next ? y : z);
  }
  return found;
}

}  // namespace

std::size_t markOneByOne(const RayBlock& rays, VoxelGrid& grid) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < rays.count; ++i)
    found += walk(rays.from, {rays.x[i], rays.y[i], rays.z[i]}, rays.length[i], grid);
  return found;
}

std::size_t mark(const RayBlock& rays, VoxelGrid& grid) {
  return hasEightLanes() ? markByEights(rays, grid) : markOneByOne(rays, grid);
}

}  // namespace spelunk::evaluation
