#include "spelunk/graph/spatial_graph.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

auto findIn(std::vector<Neighbour>& list, VertexId id) {
  return std::find_if(list.begin(), list.end(), [id](const Neighbour& n) { return n.id == id; });
}

}  // namespace

VertexId SpatialGraph::addVertex(const Eigen::Vector3d& position) {
  index_.add(position);
  neighbours_.emplace_back();
  return VertexId{static_cast<std::uint32_t>(neighbours_.size() - 1)};
}

void SpatialGraph::requireVertex(VertexId id) const {
  require(indexOf(id) < neighbours_.size(), "SpatialGraph: no such vertex");
}

void SpatialGraph::addEdge(VertexId a, VertexId b, double weight) {
  requireVertex(a);
  requireVertex(b);
  require(a != b, "SpatialGraph: an edge must join two vertices");
  require(std::isfinite(weight) && weight >= 0.0, "SpatialGraph: weight must be finite and >= 0");
  const auto found = findIn(neighbours_[indexOf(a)], b);
  if (found != neighbours_[indexOf(a)].end()) {
    found->weight = weight;
    findIn(neighbours_[indexOf(b)], a)->weight = weight;
    return;
  }
  neighbours_[indexOf(a)].push_back({b, weight});
  neighbours_[indexOf(b)].push_back({a, weight});
  ++edge_count_;
}

void SpatialGraph::removeEdge(VertexId a, VertexId b) {
  requireVertex(a);
  requireVertex(b);
  auto& of_a = neighbours_[indexOf(a)];
  auto& of_b = neighbours_[indexOf(b)];
  const auto found = findIn(of_a, b);
  if (found == of_a.end()) return;
  of_a.erase(found);
  of_b.erase(findIn(of_b, a));
  --edge_count_;
}

bool SpatialGraph::hasEdge(VertexId a, VertexId b) const {
  requireVertex(a);
  requireVertex(b);
  const auto& list = neighbours_[indexOf(a)];
  return std::any_of(list.begin(), list.end(), [b](const Neighbour& n) { return n.id == b; });
}

std::vector<std::pair<VertexId, VertexId>> SpatialGraph::edges() const {
  std::vector<std::pair<VertexId, VertexId>> all;
  all.reserve(edge_count_);
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    const VertexId id{static_cast<std::uint32_t>(i)};
    for (const Neighbour& n : neighbours_[i]) {
      if (id < n.id) all.emplace_back(id, n.id);
    }
  }
  return all;
}

std::optional<VertexId> SpatialGraph::findNearest(const Eigen::Vector3d& point) const {
  const auto nearest = index_.findNearest(point);
  if (!nearest) return std::nullopt;
  return VertexId{static_cast<std::uint32_t>(*nearest)};
}

std::vector<VertexId> SpatialGraph::findWithin(const Eigen::Vector3d& point,
                                               double radius_m) const {
  std::vector<VertexId> ids;
  for (const std::size_t index : index_.findWithin(point, radius_m)) {
    ids.push_back(VertexId{static_cast<std::uint32_t>(index)});
  }
  return ids;
}

}  // namespace spelunk::graph
