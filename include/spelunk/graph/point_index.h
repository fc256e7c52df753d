#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace spelunk::graph {

/// Points that only grow in number, searched by distance: a k-d forest that stays balanced while
/// points arrive. Answers are exact, equal distances by index. A copy shares the trees, which never
/// change, and so costs little.
class PointIndex {
 public:
  void add(const Eigen::Vector3d& point);
  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const Eigen::Vector3d& point(std::size_t index) const { return points_[index]; }

  /// The index of the nearest point; empty if there is none.
  [[nodiscard]] std::optional<std::size_t> findNearest(const Eigen::Vector3d& query) const;

  /// Indices of all points nearer than `radius_m`, nearest first, equal distances by index.
  [[nodiscard]] std::vector<std::size_t> findWithin(const Eigen::Vector3d& query,
                                                    double radius_m) const;

 private:
  class Tree;

  /// Calls `take(index, squared distance)` for every point that no tree holds yet.
  template <class F>
  void forEachLoose(const Eigen::Vector3d& query, F&& take) const;
  [[nodiscard]] std::size_t looseFrom() const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<std::shared_ptr<const Tree>>
      trees_;  ///< Of points one after the other; big ones first.
};

}  // namespace spelunk::graph
