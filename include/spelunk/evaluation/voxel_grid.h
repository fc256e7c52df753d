#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/evaluation/grid_shape.h"

namespace spelunk::evaluation {

/// One bit a voxel over a box, one voxel of margin on every side.
class VoxelGrid {
 public:
  VoxelGrid(const AxisAlignedBox& bounds, double resolution_m);

  [[nodiscard]] double resolution() const { return resolution_m_; }
  /// The lowest point of the grid.
  [[nodiscard]] const Eigen::Vector3d& corner() const { return corner_; }
  [[nodiscard]] const Eigen::Vector3i& size() const { return shape_.size; }
  [[nodiscard]] Eigen::Vector3i cellOf(const Eigen::Vector3d& point) const {
    return scaled(point).array().floor().cast<int>();
  }
  [[nodiscard]] Eigen::Vector3d centreOf(const Eigen::Vector3i& cell) const;
  /// `point` in units of voxels from the grid's corner.
  [[nodiscard]] Eigen::Vector3d scaled(const Eigen::Vector3d& point) const {
    return (point - corner_) * inverse_resolution_;
  }

  [[nodiscard]] bool contains(const Eigen::Vector3i& cell) const { return shape_.contains(cell); }
  /// Only for cells the grid contains.
  [[nodiscard]] std::size_t offsetOf(const Eigen::Vector3i& cell) const {
    return shape_.offsetOf(cell);
  }
  [[nodiscard]] Eigen::Vector3i cellAt(std::size_t offset) const { return shape_.cellAt(offset); }
  [[nodiscard]] bool isSet(std::size_t offset) const {
    return (words_[offset >> 6] >> (offset & 63) & 1) != 0;
  }
  /// Bit `offset % 64` of word `offset / 64` is the one of an offset.
  [[nodiscard]] const std::uint64_t* words() const { return words_.data(); }
  [[nodiscard]] std::size_t wordCount() const { return words_.size(); }
  /// Sets the bit; whether it was clear before.
  bool set(std::size_t offset) {
    std::uint64_t& word = words_[offset >> 6];
    const std::uint64_t bit = std::uint64_t{1} << (offset & 63);
    const bool is_new = (word & bit) == 0;
    word |= bit;
    return is_new;
  }
  /// Calls `visit` with the offset of every bit that is set, in ascending order.
  template <class Visit>
  void forEachSet(Visit&& visit) const {
    for (std::size_t word = 0; word < words_.size(); ++word)
      for (std::uint64_t bits = words_[word]; bits != 0; bits &= bits - 1)
        visit(word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits)));
  }
  void clear(std::size_t offset) { words_[offset >> 6] &= ~(std::uint64_t{1} << (offset & 63)); }

 private:
  double resolution_m_;
  double inverse_resolution_;
  Eigen::Vector3d corner_;
  GridShape shape_;
  std::vector<std::uint64_t> words_;
};

}  // namespace spelunk::evaluation
