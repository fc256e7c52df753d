#pragma once

#include "ray_walks.h"

namespace spelunk::map {

/// A dense grid of bits whose rows along x hold whole words and whose corner is one of a block.
struct RayGrid {
  VoxelIndex first;
  VoxelIndex blocks;  ///< Along each axis.
  std::size_t row_words;
  std::size_t layer_words;

  explicit RayGrid(const std::vector<RayWalk>& walks) {
    VoxelIndex low = walks.front().start;
    VoxelIndex high = low;
    for (const RayWalk& walk : walks) {
      low = low.cwiseMin(walk.end);
      high = high.cwiseMax(walk.end);
    }
    constexpr int kMargin = 2;  // voxels that rounding may lead a ray beyond its ends
    low.array() -= kMargin;
    high.array() += kMargin;
    for (int i = 0; i < 3; ++i) {
      first(i) = low(i) & ~(kBlockSide - 1);
      blocks(i) = (high(i) - first(i)) / kBlockSide + 1;
    }
    blocks.x() = (blocks.x() + 7) / 8 * 8;
    row_words = static_cast<std::size_t>(blocks.x()) / 8;
    layer_words = row_words * 8 * static_cast<std::size_t>(blocks.y());
  }

  [[nodiscard]] std::size_t words() const {
    return layer_words * 8 * static_cast<std::size_t>(blocks.z());
  }
  [[nodiscard]] std::int64_t stride(int axis) const {
    const std::size_t strides[3] = {1, 64 * row_words, 64 * layer_words};
    return static_cast<std::int64_t>(strides[axis]);
  }
  [[nodiscard]] std::int64_t offsetOf(const VoxelIndex& index) const {
    std::int64_t offset = 0;
    for (int i = 0; i < 3; ++i) offset += (index(i) - first(i)) * stride(i);
    return offset;
  }
};

}  // namespace spelunk::map
