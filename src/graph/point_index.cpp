#include "spelunk/graph/point_index.h"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

/// As many points are looked at one by one as fast as in a tree.
constexpr std::size_t kLooseMax = 32;
constexpr std::size_t kLeafSize = 12;

struct Points {
  std::vector<Eigen::Vector3d> all;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return all.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return all[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>,
                                                   Points, 3, std::size_t>;

/// A point and its squared distance; the order in which answers come.
struct Hit {
  std::size_t index = 0;
  double squared = std::numeric_limits<double>::infinity();
  bool operator<(const Hit& other) const {
    return squared != other.squared ? squared < other.squared : index < other.index;
  }
};

}  // namespace

/// A k-d tree of the points from one index on; it never changes.
class PointIndex::Tree {
 public:
  Tree(std::size_t first, std::vector<Eigen::Vector3d> points)
      : first_(first),
        points_{std::move(points)},
        tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
    tree_.buildIndex();
  }
  Tree(const Tree&) = delete;  // its index refers to its points
  Tree& operator=(const Tree&) = delete;

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return points_.all.size(); }

  void collect(const Eigen::Vector3d& query, double squared_radius, std::vector<Hit>& hits) const {
    std::vector<std::pair<std::size_t, double>> found;
    nanoflann::RadiusResultSet<double, std::size_t> result(squared_radius, found);
    tree_.findNeighbors(result, query.data(), nanoflann::SearchParams());
    for (const auto& [index, squared] : found) hits.push_back({first_ + index, squared});
  }

  [[nodiscard]] Hit nearest(const Eigen::Vector3d& query) const {
    std::size_t index = 0;
    double squared = 0.0;
    nanoflann::KNNResultSet<double, std::size_t> result(1);
    result.init(&index, &squared);
    tree_.findNeighbors(result, query.data(), nanoflann::SearchParams());
    return {first_ + index, squared};
  }

 private:
  std::size_t first_;
  Points points_;
  KdTree tree_;
};

std::size_t PointIndex::looseFrom() const {
  return trees_.empty() ? 0 : trees_.back()->first() + trees_.back()->size();
}

template <class F>
void PointIndex::forEachLoose(const Eigen::Vector3d& query, F&& take) const {
  for (std::size_t i = looseFrom(); i < points_.size(); ++i)
    take(i, (points_[i] - query).squaredNorm());
}

/// Loose points become a tree, together with all trees that are no bigger than what they join.
void PointIndex::add(const Eigen::Vector3d& point) {
  require(point.allFinite(), "PointIndex: point is not finite");
  points_.push_back(point);
  std::size_t first = looseFrom();
  if (points_.size() - first < kLooseMax) return;
  while (!trees_.empty() && trees_.back()->size() <= points_.size() - first) {
    first = trees_.back()->first();
    trees_.pop_back();
  }
  trees_.push_back(std::make_shared<const Tree>(
      first,
      std::vector<Eigen::Vector3d>(points_.begin() + static_cast<long>(first), points_.end())));
}

std::optional<std::size_t> PointIndex::findNearest(const Eigen::Vector3d& query) const {
  if (size() == 0) return std::nullopt;
  Hit best;
  for (const auto& tree : trees_) best = std::min(best, tree->nearest(query));
  forEachLoose(query, [&](std::size_t index, double squared) {
    best = std::min(best, Hit{index, squared});
  });
  return best.index;
}

std::vector<std::size_t> PointIndex::findWithin(const Eigen::Vector3d& query,
                                                double radius_m) const {
  std::vector<Hit> hits;
  const double squared_radius = radius_m * radius_m;
  if (radius_m > 0.0) {
    for (const auto& tree : trees_) tree->collect(query, squared_radius, hits);
    forEachLoose(query, [&](std::size_t index, double squared) {
      if (squared < squared_radius) hits.push_back({index, squared});
    });
  }
  std::sort(hits.begin(), hits.end());
  std::vector<std::size_t> indices;
  indices.reserve(hits.size());
  for (const Hit& hit : hits) indices.push_back(hit.index);
  return indices;
}

}  // namespace spelunk::graph
