#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>

#include "spelunk/common/box.h"
#include "spelunk/map/occupancy.h"

namespace spelunk::map {

/// The status of every voxel at one instant; immutable, shared between threads without locks.
class FrozenMap {
 public:
  struct Blocks;  ///< Opaque storage.
  FrozenMap(std::shared_ptr<const Blocks> blocks, double resolution_m);

  [[nodiscard]] double resolution() const { return resolution_m_; }
  [[nodiscard]] VoxelIndex indexOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector3d centreOf(const VoxelIndex& index) const;

  /// O(1). Outside everything seen: unknown.
  [[nodiscard]] Occupancy at(const VoxelIndex& index) const;
  [[nodiscard]] Occupancy at(const Eigen::Vector3d& point) const { return at(indexOf(point)); }

  /// Whether the voxel is unknown, was looked into from several places near by, and nothing came
  /// back from there: an opening, or rock that swallows every ray. Unknown for all that is flown;
  /// nothing more is to be seen in it.
  [[nodiscard]] bool isSilent(const VoxelIndex& index) const;

  /// Around all known voxels; empty for an empty map.
  [[nodiscard]] AxisAlignedBox knownBounds() const;
  [[nodiscard]] std::size_t freeVoxels() const;
  [[nodiscard]] std::size_t occupiedVoxels() const;

  /// Calls `visit` for every occupied voxel whose centre lies in `region`, in a fixed order.
  void forEachOccupied(const AxisAlignedBox& region,
                       const std::function<void(const VoxelIndex&)>& visit) const;

  [[nodiscard]] const Blocks& blocks() const { return *blocks_; }

 private:
  std::shared_ptr<const Blocks> blocks_;
  double resolution_m_;
};

}  // namespace spelunk::map
