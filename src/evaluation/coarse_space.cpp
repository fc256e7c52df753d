#include "coarse_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spelunk::evaluation {

VoxelGrid coarse(const ReachableSpace& space, const AxisAlignedBox& bounds, double room_m,
                 double edge_m) {
  AxisAlignedBox wide = bounds;
  wide.min.array() -= room_m;
  wide.max.array() += room_m;
  VoxelGrid grid(wide, edge_m);
  const auto take = [&grid](const VoxelGrid& fine) {
    fine.forEachSet(
        [&](std::size_t offset) { grid.set(offsetAt(grid, fine.centreOf(fine.cellAt(offset)))); });
  };
  take(space.free);
  take(space.surface);
  return grid;
}

VoxelGrid grown(const VoxelGrid& grid, double radius_m) {
  const double radius = radius_m / grid.resolution();
  const auto ball = stencil(static_cast<int>(std::ceil(radius)),
                            [&](const Eigen::Vector3d& step) { return step.norm() <= radius; });
  const auto box = stencil(1, [](const Eigen::Vector3d&) { return true; });
  VoxelGrid result = grid;
  grid.forEachSet([&](std::size_t offset) {
    const Eigen::Vector3i cell = grid.cellAt(offset);
    const bool is_inner = std::all_of(box.begin(), box.end(), [&](const Eigen::Vector3i& step) {
      return grid.contains(cell + step) && grid.isSet(grid.offsetOf(cell + step));
    });
    if (is_inner) return;  // what it reaches, a voxel of the border reaches too
    for (const Eigen::Vector3i& step : ball)
      if (result.contains(cell + step)) result.set(result.offsetOf(cell + step));
  });
  return result;
}

std::vector<int> linksFrom(const Eigen::Vector3d& start, const VoxelGrid& grid) {
  constexpr int kNever = std::numeric_limits<int>::max();
  const double reach = kLink_m / grid.resolution();
  const auto near = stencil(static_cast<int>(reach) + 1, [&](const Eigen::Vector3d& step) {
    return (step.array().abs() - 1.0).max(0.0).matrix().norm() <= reach;
  });
  const Eigen::Vector3i size = grid.size();
  std::vector<int> links(grid.offsetOf(size - Eigen::Vector3i::Ones()) + 1, kNever);
  std::vector<std::size_t> layer{offsetAt(grid, start)};
  links[layer.front()] = 0;
  for (int count = 1; !layer.empty(); ++count) {
    std::vector<std::size_t> next;
    for (const std::size_t offset : layer) {
      const Eigen::Vector3i cell = grid.cellAt(offset);
      for (const Eigen::Vector3i& step : near) {
        const Eigen::Vector3i other = cell + step;
        if (!grid.contains(other)) continue;
        const std::size_t place = grid.offsetOf(other);
        if (links[place] != kNever || !grid.isSet(place)) continue;
        links[place] = count;
        next.push_back(place);
      }
    }
    layer = std::move(next);
  }
  return links;
}

bool isClear(const VoxelGrid& grid, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = grid.scaled(from);
  const Eigen::Vector3d way = grid.scaled(to) - a;
  Eigen::Vector3i cell = grid.cellOf(from);
  const Eigen::Vector3i end = grid.cellOf(to);
  Eigen::Vector3d next;
  Eigen::Vector3d spacing;
  Eigen::Vector3i step;
  for (int i = 0; i < 3; ++i) {
    step(i) = way(i) > 0.0 ? 1 : -1;
    spacing(i) = way(i) == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(way(i));
    const double border = step(i) > 0 ? cell(i) + 1.0 - a(i) : a(i) - cell(i);
    next(i) = way(i) == 0.0 ? spacing(i) : border * spacing(i);
  }
  for (int left = (end - cell).cwiseAbs().sum(); left >= 0; --left) {
    if (!grid.isSet(grid.offsetOf(cell))) return false;
    int axis = 0;
    next.minCoeff(&axis);
    if (left == 0) break;
    cell(axis) += step(axis);
    next(axis) += spacing(axis);
  }
  return true;
}

}  // namespace spelunk::evaluation
