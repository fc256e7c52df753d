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

/// For each voxel of a chunk, whether the box that begins there is free: one bit a voxel for each
/// of the eight phases (one bit an axis, set if the box spans one voxel more).
class InflatedChunk {
 public:
  /// A chunk and those after it along x (bit 0 of the place), y (1) and z (2); nullptr: unknown.
  using Sources = std::array<std::shared_ptr<const StatusChunk>, 8>;

  InflatedChunk(const Sources& sources, const BoxSpan& span, Passable passable);

  /// Coordinates within the chunk.
  [[nodiscard]] bool isFree(std::size_t phase, int x, int y, int z) const {
    return ((rows_[phase][static_cast<std::size_t>(z * kChunkSide + y)] >> x) & 1) != 0;
  }
  /// Whether no box that begins in the chunk is free.
  [[nodiscard]] bool isBlocked() const { return is_blocked_; }

 private:
  using Rows = std::array<std::uint32_t, kChunkSide * kChunkSide>;
  std::vector<Rows> rows_;  ///< One a phase; empty if blocked.
  bool is_blocked_ = true;
};

}  // namespace spelunk::map
