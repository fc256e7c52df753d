#pragma once

#include <cstdint>
#include <vector>

#include "spelunk/map/local_window.h"

namespace spelunk::map {

/// One bit a voxel of a window, rows of x padded to whole words; outside it every bit is 0.
class BitGrid {
 public:
  BitGrid() = default;

  /// The cells of `window` that hold `status` (free or occupied).
  BitGrid(const LocalWindow& window, Occupancy status);
  /// The cells of `window` that are not occupied: free or unknown.
  [[nodiscard]] static BitGrid notOccupied(const LocalWindow& window);

  [[nodiscard]] bool at(const VoxelIndex& local) const {
    if (static_cast<unsigned>(local.x()) >= static_cast<unsigned>(size_.x()) ||
        static_cast<unsigned>(local.y()) >= static_cast<unsigned>(size_.y()) ||
        static_cast<unsigned>(local.z()) >= static_cast<unsigned>(size_.z()))
      return false;
    const std::size_t word = rowOf(local.y(), local.z()) + static_cast<unsigned>(local.x()) / 64;
    return ((words_[word] >> (local.x() & 63)) & 1) != 0;
  }

  /// Whether any bit of the closed index box is set; parts outside the grid count as 0.
  [[nodiscard]] bool isAnySet(const VoxelIndex& first, const VoxelIndex& last) const;
  /// Whether all bits of the closed index box are set.
  [[nodiscard]] bool areAllSet(const VoxelIndex& first, const VoxelIndex& last) const;

  /// Each bit becomes the AND of itself and the bit `shift` farther along `axis`.
  void andShifted(int axis, int shift);

  /// Each bit becomes the AND of `length` bits from itself on along `axis`.
  void erode(int axis, int length);

 private:
  void enter(const LocalWindow& window, unsigned status_bit, std::uint64_t flip);
  [[nodiscard]] std::size_t rowOf(int y, int z) const {
    return row_words_ * (static_cast<std::size_t>(y) +
                         static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(z));
  }
  void andShiftedInRows(std::size_t shift);

  VoxelIndex size_ = VoxelIndex::Zero();
  std::size_t row_words_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace spelunk::map
