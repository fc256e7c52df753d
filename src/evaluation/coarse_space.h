#pragma once

#include <Eigen/Core>
#include <vector>

#include "spelunk/evaluation/reachable_volume.h"

namespace spelunk::evaluation {

/// Of the chain that stands for a path, metres.
constexpr double kLink_m = 3.0;

/// Index differences that satisfy a condition, within `reach` on every axis.
template <class Condition>
[[nodiscard]] std::vector<Eigen::Vector3i> stencil(int reach, Condition&& isIn) {
  std::vector<Eigen::Vector3i> offsets;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (isIn(Eigen::Vector3d(x, y, z))) offsets.emplace_back(x, y, z);
  return offsets;
}

/// The offset of the voxel around a point of the grid.
[[nodiscard]] inline std::size_t offsetAt(const VoxelGrid& grid, const Eigen::Vector3d& point) {
  return grid.offsetOf(grid.cellOf(point));
}

/// Voxels that hold a reachable point, of a grid that reaches `room_m` beyond the bounds.
[[nodiscard]] VoxelGrid coarse(const ReachableSpace& space, const AxisAlignedBox& bounds,
                               double room_m, double edge_m);

/// All voxels whose centre lies within `radius_m` of the centre of a set one.
[[nodiscard]] VoxelGrid grown(const VoxelGrid& grid, double radius_m);

/// Links from the start to every set voxel, by its offset: each joins two set voxels that hold
/// points at most kLink_m apart. The longest int where none lead.
[[nodiscard]] std::vector<int> linksFrom(const Eigen::Vector3d& start, const VoxelGrid& grid);

/// Whether the straight line between two points of a grid runs through set voxels only.
[[nodiscard]] bool isClear(const VoxelGrid& grid, const Eigen::Vector3d& from,
                           const Eigen::Vector3d& to);

}  // namespace spelunk::evaluation
