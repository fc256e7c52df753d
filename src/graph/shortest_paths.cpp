#include "spelunk/graph/shortest_paths.h"

#include <algorithm>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "boost_view.h"
#include "spelunk/common/contract.h"

namespace spelunk::graph {
bool ShortestPaths::reaches(VertexId id) const { return std::isfinite(distances_[indexOf(id)]); }

std::vector<VertexId> ShortestPaths::pathTo(VertexId id) const {
  if (!reaches(id)) return {};
  std::vector<VertexId> path{id};
  while (path.back() != source_) path.push_back(predecessorOf(path.back()));
  std::reverse(path.begin(), path.end());
  return path;
}

void ShortestPaths::takeVertices(const SpatialGraph& graph) {
  distances_.resize(graph.vertexCount(), std::numeric_limits<double>::infinity());
  for (std::size_t i = predecessors_.size(); i < graph.vertexCount(); ++i)
    predecessors_.push_back(VertexId{static_cast<std::uint32_t>(i)});
}

bool ShortestPaths::takeStep(VertexId from, VertexId to, double weight) {
  const double distance = distanceTo(from) + weight;
  if (!(distance < distanceTo(to))) return false;
  distances_[indexOf(to)] = distance;
  predecessors_[indexOf(to)] = from;
  return true;
}

void ShortestPaths::takeEdge(const SpatialGraph& graph, VertexId a, VertexId b) {
  takeVertices(graph);
  using Entry = std::pair<double, VertexId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(distanceTo(a), a);
  open.emplace(distanceTo(b), b);
  while (!open.empty()) {
    const auto [distance, from] = open.top();
    open.pop();
    if (distance > distanceTo(from)) continue;  // a shorter way to it was found since
    for (const Neighbour& n : graph.neighbours(from))
      if (takeStep(from, n.id, n.weight)) open.emplace(distanceTo(n.id), n.id);
  }
}

ShortestPaths shortestPaths(const SpatialGraph& graph, VertexId source) {
  require(indexOf(source) < graph.vertexCount(), "shortestPaths: no such source");
  const std::size_t count = graph.vertexCount();
  std::vector<double> distances(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(count);
  const boost::typed_identity_property_map<std::size_t> number;
  boost::dijkstra_shortest_paths(
      BoostView(graph), indexOf(source),
      boost::vertex_index_map(number)
          .weight_map(BoostView::Weights{})
          .distance_map(boost::make_iterator_property_map(distances.begin(), number))
          .predecessor_map(boost::make_iterator_property_map(before.begin(), number))
          .distance_inf(std::numeric_limits<double>::infinity()));
  std::vector<VertexId> predecessors;
  predecessors.reserve(count);
  for (const std::size_t i : before) {
    predecessors.push_back(VertexId{static_cast<std::uint32_t>(i)});
  }
  return ShortestPaths(source, std::move(distances), std::move(predecessors));
}

}  // namespace spelunk::graph
