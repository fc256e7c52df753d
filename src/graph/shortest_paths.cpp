#include "spelunk/graph/shortest_paths.h"

#include <algorithm>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <limits>

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
