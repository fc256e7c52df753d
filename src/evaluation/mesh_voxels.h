#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "spelunk/evaluation/voxel_grid.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// A triangle so near to the border of two voxels lies between them and runs through neither. Far
/// above the rounding of the tests (1e-11 m in a world of kilometres), far below a voxel.
constexpr double kFlush_m = 1e-6;

/// How the triangles of a mesh part the voxels of a grid over its bounds. A step between the
/// centres of neighbours that `joins` calls clear crosses no triangle, whatever the rounding: the
/// line between the centres lies within three boxes (both voxels without a rim of kFlush_m, and a
/// plate of 4 kFlush_m on the face they share) that no triangle comes within rounding of.
class MeshVoxels {
 public:
  MeshVoxels(const sim::WorldMesh& mesh, double resolution_m);

  [[nodiscard]] const VoxelGrid& grid() const { return met_; }

  /// Whether a triangle runs through a voxel.
  [[nodiscard]] bool isMet(std::size_t offset) const { return met_.isSet(offset); }

  /// Whether the way from a voxel to the next one along an axis is clear of the mesh.
  [[nodiscard]] bool joins(std::size_t offset, int axis) const;

  /// Voxels within the bounds of the mesh, from `first` to `last`; those that only touch the
  /// bounds lie outside.
  [[nodiscard]] const Eigen::Vector3i& first() const { return first_; }
  [[nodiscard]] const Eigen::Vector3i& last() const { return last_; }
  [[nodiscard]] bool isWithin(const Eigen::Vector3i& cell) const {
    return (cell.array() >= first_.array()).all() && (cell.array() <= last_.array()).all();
  }

  /// All voxels that a triangle meets or touches; nothing else is left of this.
  [[nodiscard]] VoxelGrid takeSurface() &&;

 private:
  VoxelGrid met_;
  VoxelGrid touched_;               ///< A triangle lies on their border; may be met as well.
  std::vector<std::size_t> walls_;  ///< 3 * offset + axis, ascending: between a voxel and the next.
  Eigen::Vector3i first_;
  Eigen::Vector3i last_;
};

}  // namespace spelunk::evaluation
