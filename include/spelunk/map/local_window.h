#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "spelunk/common/box.h"
#include "spelunk/common/contract.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// Dense copy of a region of the map, one byte a voxel: what rays of planning read. Columns along z
/// lie in one piece: caves are low, so what is known and what rays read shares fewer pages and
/// cache lines. Memory where nothing is known is never touched, so the system does not provide it.
class LocalWindow {
 public:
  /// Copies every voxel that `region` touches. Throws Precondition if the region is empty, not
  /// finite or larger than 2^31 voxels.
  LocalWindow(const FrozenMap& map, const AxisAlignedBox& region);

  /// Makes it a copy of the same region of `now`. It must be one of `before`: if `now` came from
  /// that by changes, only what changed is copied.
  void update(const FrozenMap& before, const FrozenMap& now);

  /// Outside the window: unknown.
  [[nodiscard]] Occupancy at(const VoxelIndex& index) const {
    // Unsigned, so that one comparison an axis covers both sides and nothing can overflow.
    const auto local = [&](int axis) {
      return static_cast<unsigned>(index(axis)) - static_cast<unsigned>(origin_(axis));
    };
    const unsigned x = local(0);
    const unsigned y = local(1);
    const unsigned z = local(2);
    const auto size = [&](int axis) { return static_cast<unsigned>(size_(axis)); };
    if (x >= size(0) || y >= size(1) || z >= size(2)) return Occupancy::kUnknown;
    return static_cast<Occupancy>(cells_[z + column_cells_ * x + plane_cells_ * y]);
  }
  [[nodiscard]] Occupancy at(const Eigen::Vector3d& point) const { return at(indexOf(point)); }

  [[nodiscard]] VoxelIndex indexOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector3d centreOf(const VoxelIndex& index) const;
  [[nodiscard]] double resolution() const { return resolution_m_; }
  [[nodiscard]] const VoxelIndex& origin() const { return origin_; }  ///< Index of cell (0, 0, 0).
  [[nodiscard]] const VoxelIndex& size() const { return size_; }
  /// Occupancy as numbers, z fastest, then x; cellCount() of them.
  [[nodiscard]] const std::uint8_t* cells() const { return cells_.get(); }
  [[nodiscard]] std::size_t cellCount() const { return cell_count_; }
  /// Indices of a box outside which every voxel is unknown; first > last if all are.
  [[nodiscard]] const VoxelIndex& knownFirst() const { return known_first_; }
  [[nodiscard]] const VoxelIndex& knownLast() const { return known_last_; }
  [[nodiscard]] AxisAlignedBox region() const;  ///< Around its voxels.

  [[nodiscard]] std::size_t offsetOf(const VoxelIndex& local) const {
    return static_cast<std::size_t>(local.z()) +
           column_cells_ * static_cast<std::size_t>(local.x()) +
           plane_cells_ * static_cast<std::size_t>(local.y());
  }

 private:
  struct FreeMemory {
    void operator()(std::uint8_t* memory) const { std::free(memory); }
  };

  double resolution_m_;
  VoxelIndex origin_;
  VoxelIndex size_;
  std::size_t column_cells_ = 0;  ///< Along z.
  std::size_t plane_cells_ = 0;   ///< Along z and x.
  std::size_t cell_count_ = 0;
  VoxelIndex known_first_ = VoxelIndex::Constant(1 << 30);
  VoxelIndex known_last_ = VoxelIndex::Constant(-(1 << 30));
  std::unique_ptr<std::uint8_t[], FreeMemory> cells_;
};

}  // namespace spelunk::map
