#include "spelunk/graph/shortest_paths.h"

#include <algorithm>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

struct Length {
  double metres = 0.0;
};
using Csr = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, Length>;

Csr toCsr(const SpatialGraph& graph) {
  std::vector<std::pair<std::size_t, std::size_t>> arcs;
  std::vector<Length> lengths;
  arcs.reserve(2 * graph.edgeCount());
  lengths.reserve(2 * graph.edgeCount());
  for (std::size_t i = 0; i < graph.vertexCount(); ++i) {
    for (const Neighbour& n : graph.neighbours(VertexId{static_cast<std::uint32_t>(i)})) {
      arcs.emplace_back(i, indexOf(n.id));
      lengths.push_back({n.weight});
    }
  }
  return Csr(boost::edges_are_sorted, arcs.begin(), arcs.end(), lengths.begin(),
             graph.vertexCount());
}

}  // namespace

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
  const Csr csr = toCsr(graph);
  const std::size_t count = graph.vertexCount();
  std::vector<double> distances(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(count);
  const auto vertex_index = boost::get(boost::vertex_index, csr);
  boost::dijkstra_shortest_paths(
      csr, indexOf(source),
      boost::weight_map(boost::get(&Length::metres, csr))
          .distance_map(boost::make_iterator_property_map(distances.begin(), vertex_index))
          .predecessor_map(boost::make_iterator_property_map(before.begin(), vertex_index))
          .distance_inf(std::numeric_limits<double>::infinity()));
  std::vector<VertexId> predecessors;
  predecessors.reserve(count);
  for (const std::size_t i : before) {
    predecessors.push_back(VertexId{static_cast<std::uint32_t>(i)});
  }
  return ShortestPaths(source, std::move(distances), std::move(predecessors));
}

}  // namespace spelunk::graph
