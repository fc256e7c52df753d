#pragma once

#include <vector>

#include "spelunk/graph/spatial_graph.h"

namespace spelunk::graph {

/// Shortest paths from one vertex to all others.
class ShortestPaths {
 public:
  ShortestPaths(VertexId source, std::vector<double> distances, std::vector<VertexId> predecessors)
      : source_(source), distances_(std::move(distances)), predecessors_(std::move(predecessors)) {}

  [[nodiscard]] VertexId source() const { return source_; }
  [[nodiscard]] bool reaches(VertexId id) const;
  /// Sum of weights; infinity if it is not reached.
  [[nodiscard]] double distanceTo(VertexId id) const { return distances_[indexOf(id)]; }
  /// The vertex before `id`; the source and unreached vertices have themselves.
  [[nodiscard]] VertexId predecessorOf(VertexId id) const { return predecessors_[indexOf(id)]; }
  /// From the source to `id`, both included; empty if it is not reached.
  [[nodiscard]] std::vector<VertexId> pathTo(VertexId id) const;

  /// Takes up vertices that joined `graph` since; none of them is reached yet.
  void takeVertices(const SpatialGraph& graph);
  /// Takes up those and the edge between `a` and `b`, which is new or has become shorter. Costs as
  /// much as there are distances that change.
  void takeEdge(const SpatialGraph& graph, VertexId a, VertexId b);

 private:
  /// Whether the way to `to` by its neighbour `from` is shorter than the one known; takes it then.
  bool takeStep(VertexId from, VertexId to, double weight);

  VertexId source_;
  std::vector<double> distances_;
  std::vector<VertexId> predecessors_;
};

/// Dijkstra's algorithm. Among equally long paths the result depends on the order edges were added
/// in only, so it repeats.
[[nodiscard]] ShortestPaths shortestPaths(const SpatialGraph& graph, VertexId source);

}  // namespace spelunk::graph
