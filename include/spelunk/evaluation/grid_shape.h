#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace spelunk::evaluation {

/// Cells of a dense grid and their places in one array, x fastest.
struct GridShape {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
           static_cast<std::size_t>(size.z());
  }
  [[nodiscard]] bool contains(const Eigen::Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size.array()).all();
  }
  /// Only for cells the grid contains.
  [[nodiscard]] std::size_t offsetOf(const Eigen::Vector3i& cell) const {
    return static_cast<std::size_t>(cell.x()) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(cell.y()) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(cell.z()));
  }
  [[nodiscard]] Eigen::Vector3i cellAt(std::size_t offset) const {
    const auto row = static_cast<std::size_t>(size.x());
    const auto layer = row * static_cast<std::size_t>(size.y());
    return {static_cast<int>(offset % row), static_cast<int>(offset % layer / row),
            static_cast<int>(offset / layer)};
  }
};

}  // namespace spelunk::evaluation
