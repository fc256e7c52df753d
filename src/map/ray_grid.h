#pragma once

#include <algorithm>

#include "ray_walks.h"

namespace spelunk::map {

/// A dense grid of bits whose rows along x hold whole words and whose corner is one of a block.
struct RayGrid {
  VoxelIndex first;
  VoxelIndex blocks;  ///< Along each axis.
  std::size_t row_words;
  std::size_t layer_words;

  explicit RayGrid(const RayWalks& walks) {
    VoxelIndex low = walks.start;
    VoxelIndex high = low;
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < walks.count; ++i) {
        low(axis) = std::min(low(axis), walks.end[axis][i]);
        high(axis) = std::max(high(axis), walks.end[axis][i]);
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
