#include "spelunk/planners/informed/reachability_graph.h"

#include <algorithm>
#include <tuple>

#include "spelunk/common/contract.h"

namespace spelunk::planners::informed {
namespace {

using graph::FoundPath;
using graph::Polyline;
using graph::VertexId;

constexpr double kSamePlace_m = 1e-6;

VertexId idOf(std::size_t i) { return VertexId{static_cast<std::uint32_t>(i)}; }

}  // namespace

bool isBefore(const map::VoxelIndex& a, const map::VoxelIndex& b) {
  return std::make_tuple(a.z(), a.y(), a.x()) < std::make_tuple(b.z(), b.y(), b.x());
}

std::vector<VertexId> ReachabilityGraph::vertices() const {
  std::vector<VertexId> all;
  for (std::size_t i = 0; i < labels_.size(); ++i) all.push_back(idOf(i));
  return all;
}

AxisAlignedBox ReachabilityGraph::boxOf(VertexId vertex) const {
  return boxAround(graph_.position(vertex), Eigen::Vector3d::Constant(2.0 * range_m_));
}

VertexId ReachabilityGraph::insertVertex(const Eigen::Vector3d& position) {
  labels_.emplace_back();
  return graph_.addVertex(position);
}

void ReachabilityGraph::insertEdge(VertexId from, VertexId to, Polyline way) {
  require(!way.empty() && (way.front() - graph_.position(from)).norm() < kSamePlace_m &&
              (way.back() - graph_.position(to)).norm() < kSamePlace_m,
          "ReachabilityGraph: a way must begin and end at its vertices");
  if (from == to) return;
  const double cost = graph::lengthOf(way);
  const Edge edge = std::minmax(from, to);
  const auto known = ways_.find(edge);
  if (known != ways_.end() && graph::lengthOf(known->second) <= cost) return;
  if (to < from) std::reverse(way.begin(), way.end());
  ways_[edge] = std::move(way);
  graph_.addEdge(from, to, cost);
}

void ReachabilityGraph::removeEdge(VertexId a, VertexId b) {
  graph_.removeEdge(a, b);
  ways_.erase(Edge(std::minmax(a, b)));
}

Polyline ReachabilityGraph::wayOf(VertexId from, VertexId to) const {
  const auto known = ways_.find(Edge(std::minmax(from, to)));
  require(known != ways_.end(), "ReachabilityGraph: the vertices are not joined");
  Polyline way = known->second;
  if (to < from) std::reverse(way.begin(), way.end());
  return way;
}

const VertexLabel& ReachabilityGraph::labelOf(VertexId vertex) const {
  return labels_[indexOf(vertex)];
}

Polyline ReachabilityGraph::lineOf(const FoundPath& path) const {
  Polyline line;
  if (path.isFound()) line.push_back(graph_.position(path.vertices.front()));
  for (std::size_t i = 1; i < path.vertices.size(); ++i) {
    const Polyline way = wayOf(path.vertices[i - 1], path.vertices[i]);
    line.insert(line.end(), way.begin() + 1, way.end());
  }
  return line;
}

std::vector<RankedVertex> ReachabilityGraph::rank(VertexId from) const {
  std::vector<RankedVertex> ranked;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (labels_[i].is_explored) continue;
    const FoundPath path = cheapestPath(from, idOf(i));
    if (path.isFound()) ranked.push_back({idOf(i), path.length});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedVertex& a, const RankedVertex& b) {
    return a.distance_m < b.distance_m;
  });
  return ranked;
}

GraphLayer ReachabilityGraph::layer() const {
  GraphLayer layer{"reachability", {}, {}};
  for (std::size_t i = 0; i < labels_.size(); ++i)
    layer.vertices.push_back({graph_.position(idOf(i)), 0.0, !labels_[i].is_explored});
  for (const auto& [a, b] : graph_.edges())
    layer.edges.emplace_back(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  return layer;
}

void ReachabilityGraph::restore(const GraphLayer& layer) {
  *this = ReachabilityGraph(range_m_);
  for (const GraphVertex& vertex : layer.vertices) insertVertex(vertex.position);
  for (const auto& [a, b] : layer.edges) {
    if (a >= layer.vertices.size() || b >= layer.vertices.size()) continue;
    insertEdge(idOf(a), idOf(b), {layer.vertices[a].position, layer.vertices[b].position});
  }
}

}  // namespace spelunk::planners::informed
