#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "frozen_blocks.h"
#include "spelunk/map/configuration_space.h"

namespace spelunk::map {

/// A box of voxels by its phase: on each axis it spans `span` + 1 voxels, or one more.
struct BoxSpan {
  VoxelIndex least;  ///< Last minus first voxel at the box's best phase.

  /// Whether a chunk and its next neighbours hold every box that begins in the chunk.
  [[nodiscard]] bool fitsChunks() const { return (least.array() < kChunkSide).all(); }
};

/// For each voxel of a chunk, whether the box at its best phase that begins there is free: one bit
/// a voxel. A box that spans one voxel more is what two such boxes beside each other cover.
class InflatedChunk {
 public:
  /// A chunk and those after it along x (bit 0 of the place), y (1) and z (2); nullptr: unknown.
  using Sources = std::array<std::shared_ptr<const StatusChunk>, 8>;

  InflatedChunk(const Sources& sources, const BoxSpan& span, Passable passable);

  /// `first`: where the box begins, within the chunk; `extra`: 0 or 1, how many voxels more than
  /// the least it spans on each axis. Not to be asked if all is blocked.
  [[nodiscard]] bool isFree(const VoxelIndex& first, const VoxelIndex& extra) const {
    const std::uint64_t* row = rows_.data() + kRows * first.z() + first.y();
    const std::ptrdiff_t y = extra.y();
    const std::ptrdiff_t z = kRows * extra.z();
    const std::uint64_t free = row[0] & row[y] & row[z] & row[y + z];
    return (((free & (free >> extra.x())) >> first.x()) & 1) != 0;
  }
  /// Whether no box is free that begins in the chunk or right after it.
  [[nodiscard]] bool isBlocked() const { return rows_.empty(); }

 private:
  static constexpr int kRows = kChunkSide + 1;  ///< Along y and z; with the first after the chunk.

  std::vector<std::uint64_t> rows_;  ///< Along x, by z, then y; empty if blocked.
};

}  // namespace spelunk::map
