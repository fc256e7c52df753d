#pragma once

#include <vector>

#include "spelunk/graph/spatial_graph.h"

namespace spelunk::graph {

/// The vertices of a shortest path.
struct FoundPath {
  std::vector<VertexId> vertices;  ///< Both ends included; empty if the goal is not reached.
  double length = 0.0;             ///< Sum of weights; infinity if the goal is not reached.

  [[nodiscard]] bool isFound() const { return !vertices.empty(); }
};

/// A* with the straight distance between positions as heuristic (Hart, Nilsson, Raphael, 1968; as
/// Boost.Graph has it). Exact if no edge weighs less than its vertices are apart, as lengths of
/// paths do. Throws Precondition for vertices that do not exist.
[[nodiscard]] FoundPath findShortestPath(const SpatialGraph& graph, VertexId from, VertexId to);

}  // namespace spelunk::graph
