#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace spelunk::graph {

/// Points that only grow in number, searched by distance: a k-d forest that stays balanced while
/// points arrive. Answers are exact.
class PointIndex {
 public:
  PointIndex();
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  void add(const Eigen::Vector3d& point);
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] const Eigen::Vector3d& point(std::size_t index) const;

  /// The index of the nearest point; empty if there is none.
  [[nodiscard]] std::optional<std::size_t> findNearest(const Eigen::Vector3d& query) const;

  /// Indices of all points nearer than `radius_m`, nearest first, equal distances by index.
  [[nodiscard]] std::vector<std::size_t> findWithin(const Eigen::Vector3d& query,
                                                    double radius_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::graph
