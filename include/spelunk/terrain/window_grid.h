#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace spelunk::terrain {

/// Index of a cell: floor(coordinate / cell size) in world x and y.
using CellIndex = Eigen::Vector2i;

/// A square window of cells that moves over the world. Cells keep their place in storage when the
/// window moves (a circular buffer on both axes), so only cells that enter need to be written.
class WindowGrid {
 public:
  /// Reaches `reach_m` each way from the middle cell. Throws Precondition unless both are positive
  /// and finite and a side has at most 4096 cells.
  WindowGrid(double cell_m, double reach_m);

  [[nodiscard]] double cell() const { return cell_m_; }
  [[nodiscard]] int side() const { return side_; }                 ///< Cells along an axis.
  [[nodiscard]] const CellIndex& first() const { return first_; }  ///< Lowest cell in the window.
  [[nodiscard]] CellIndex middle() const { return first_.array() + side_ / 2; }
  [[nodiscard]] std::size_t slots() const { return static_cast<std::size_t>(stride_) * stride_; }

  [[nodiscard]] CellIndex cellOf(const Eigen::Vector2d& xy) const;
  [[nodiscard]] Eigen::Vector2d centreOf(const CellIndex& cell) const {
    return (cell.cast<double>().array() + 0.5) * cell_m_;
  }
  [[nodiscard]] bool contains(const CellIndex& cell) const {
    return static_cast<unsigned>(cell.x() - first_.x()) < static_cast<unsigned>(side_) &&
           static_cast<unsigned>(cell.y() - first_.y()) < static_cast<unsigned>(side_);
  }
  /// Place in storage; meaningful for cells in the window.
  [[nodiscard]] std::size_t slotOf(int x, int y) const {
    return static_cast<std::size_t>(y & mask_) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(x & mask_);
  }
  [[nodiscard]] std::size_t slotOf(const CellIndex& cell) const {
    return slotOf(cell.x(), cell.y());
  }

  /// Centres the window at `middle`.
  void moveTo(const CellIndex& middle) { first_ = middle.array() - side_ / 2; }

 private:
  double cell_m_;
  int side_;
  int stride_;  ///< A power of two, at least the side.
  int mask_;
  CellIndex first_ = CellIndex::Zero();
};

}  // namespace spelunk::terrain
