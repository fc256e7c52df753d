#include "spelunk/graph/a_star.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"
#include "spelunk/graph/shortest_paths.h"

namespace spelunk::graph {
namespace {

VertexId vertex(int i) { return VertexId{static_cast<std::uint32_t>(i)}; }

/// Edges are as long as detours: never shorter than the straight line.
SpatialGraph roads(Rng& rng, int vertices, int edges) {
  SpatialGraph graph;
  for (int i = 0; i < vertices; ++i) {
    const double x = rng.uniform(0.0, 50.0);
    graph.addVertex({x, rng.uniform(0.0, 50.0), rng.uniform(0.0, 5.0)});
  }
  for (int i = 0; i < edges; ++i) {
    const VertexId a = vertex(rng.below(vertices));
    const VertexId b = vertex(rng.below(vertices));
    const double straight = (graph.position(a) - graph.position(b)).norm();
    if (a != b) graph.addEdge(a, b, straight * rng.uniform(1.0, 2.0));
  }
  return graph;
}

double weightBetween(const SpatialGraph& graph, VertexId a, VertexId b) {
  for (const Neighbour& n : graph.neighbours(a))
    if (n.id == b) return n.weight;
  return std::nan("");
}

TEST(AStar, EqualsDijkstraOnRandomRoads) {
  Rng rng(3);
  int reached = 0;
  int missed = 0;
  for (int round = 0; round < 30; ++round) {
    const SpatialGraph graph = roads(rng, 40, 45);
    const VertexId from = vertex(rng.below(40));
    const ShortestPaths wanted = shortestPaths(graph, from);
    for (int i = 0; i < 40; ++i) {
      const FoundPath path = findShortestPath(graph, from, vertex(i));
      ASSERT_EQ(path.isFound(), wanted.reaches(vertex(i)));
      ++(path.isFound() ? reached : missed);
      if (!path.isFound()) continue;
      EXPECT_NEAR(path.length, wanted.distanceTo(vertex(i)), 1e-9);
      double sum = 0.0;
      for (std::size_t k = 1; k < path.vertices.size(); ++k)
        sum += weightBetween(graph, path.vertices[k - 1], path.vertices[k]);
      EXPECT_NEAR(sum, path.length, 1e-9);
      EXPECT_EQ(path.vertices.front(), from);
      EXPECT_EQ(path.vertices.back(), vertex(i));
    }
  }
  EXPECT_GT(reached, 100);
  EXPECT_GT(missed, 100);
}

TEST(AStar, FromAVertexToItselfIsThatVertex) {
  SpatialGraph graph;
  const VertexId only = graph.addVertex({1.0, 2.0, 3.0});
  const FoundPath path = findShortestPath(graph, only, only);
  EXPECT_EQ(path.vertices, std::vector<VertexId>{only});
  EXPECT_EQ(path.length, 0.0);
}

TEST(AStar, RefusesVerticesThatDoNotExist) {
  SpatialGraph graph;
  const VertexId only = graph.addVertex({0.0, 0.0, 0.0});
  EXPECT_THROW(static_cast<void>(findShortestPath(graph, only, vertex(1))), Precondition);
}

}  // namespace
}  // namespace spelunk::graph
