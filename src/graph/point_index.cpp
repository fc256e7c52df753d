#include "spelunk/graph/point_index.h"

#include <algorithm>
#include <nanoflann.hpp>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

constexpr std::size_t kPointsMax = 1U << 22U;  // sizes the forest: one tree a power of two
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

using Forest =
    nanoflann::KDTreeSingleIndexDynamicAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points,
                                               3, std::size_t>;

}  // namespace

struct PointIndex::Impl {
  Points points;
  Forest forest{3, points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize), kPointsMax};
};

PointIndex::PointIndex() : impl_(std::make_unique<Impl>()) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

void PointIndex::add(const Eigen::Vector3d& point) {
  require(point.allFinite(), "PointIndex: point is not finite");
  impl_->points.all.push_back(point);
  const std::size_t index = impl_->points.all.size() - 1;
  impl_->forest.addPoints(index, index);
}

std::size_t PointIndex::size() const { return impl_->points.all.size(); }

const Eigen::Vector3d& PointIndex::point(std::size_t index) const {
  return impl_->points.all[index];
}

std::optional<std::size_t> PointIndex::findNearest(const Eigen::Vector3d& query) const {
  if (size() == 0) return std::nullopt;
  std::size_t index = 0;
  double squared = 0.0;
  nanoflann::KNNResultSet<double, std::size_t> result(1);
  result.init(&index, &squared);
  impl_->forest.findNeighbors(result, query.data(), nanoflann::SearchParams());
  return index;
}

std::vector<std::size_t> PointIndex::findWithin(const Eigen::Vector3d& query,
                                                double radius_m) const {
  std::vector<std::pair<std::size_t, double>> hits;
  if (size() > 0 && radius_m > 0.0) {
    nanoflann::RadiusResultSet<double, std::size_t> result(radius_m * radius_m, hits);
    impl_->forest.findNeighbors(result, query.data(), nanoflann::SearchParams());
  }
  std::sort(hits.begin(), hits.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second < b.second : a.first < b.first;
  });
  std::vector<std::size_t> indices;
  indices.reserve(hits.size());
  for (const auto& hit : hits) indices.push_back(hit.first);
  return indices;
}

}  // namespace spelunk::graph
