#include "spelunk/graph/shortest_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::graph {
namespace {

VertexId vertex(std::size_t i) { return VertexId{static_cast<std::uint32_t>(i)}; }

SpatialGraph randomGraph(Rng& rng, int vertices, int edges) {
  SpatialGraph graph;
  for (int i = 0; i < vertices; ++i) {
    const double x = rng.uniform();
    graph.addVertex({x, rng.uniform(), 0.0});
  }
  for (int i = 0; i < edges; ++i) {
    const auto a = static_cast<std::size_t>(rng.below(vertices));
    const auto b = static_cast<std::size_t>(rng.below(vertices));
    if (a != b) graph.addEdge(vertex(a), vertex(b), rng.uniform(0.1, 5.0));
  }
  return graph;
}

/// Bellman and Ford: all edges relaxed as often as there are vertices.
std::vector<double> distancesByRelaxation(const SpatialGraph& graph, VertexId source) {
  std::vector<double> distance(graph.vertexCount(), std::numeric_limits<double>::infinity());
  distance[indexOf(source)] = 0.0;
  for (std::size_t round = 0; round < graph.vertexCount(); ++round) {
    for (std::size_t i = 0; i < graph.vertexCount(); ++i) {
      for (const Neighbour& n : graph.neighbours(vertex(i)))
        distance[indexOf(n.id)] = std::min(distance[indexOf(n.id)], distance[i] + n.weight);
    }
  }
  return distance;
}

TEST(ShortestPaths, AgreeWithRelaxationOnRandomGraphs) {
  Rng rng(11);
  for (int round = 0; round < 20; ++round) {
    const SpatialGraph graph = randomGraph(rng, 40, 70);
    const ShortestPaths paths = shortestPaths(graph, vertex(3));
    const std::vector<double> expected = distancesByRelaxation(graph, vertex(3));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (std::isinf(expected[i]))
        EXPECT_FALSE(paths.reaches(vertex(i)));
      else
        EXPECT_NEAR(paths.distanceTo(vertex(i)), expected[i], 1e-9);
    }
  }
}

TEST(ShortestPaths, GiveAPathWhoseEdgesExistAndAddUp) {
  Rng rng(12);
  const SpatialGraph graph = randomGraph(rng, 60, 200);
  const ShortestPaths paths = shortestPaths(graph, vertex(0));
  for (std::size_t i = 0; i < graph.vertexCount(); ++i) {
    const std::vector<VertexId> path = paths.pathTo(vertex(i));
    if (path.empty()) continue;
    double sum = 0.0;
    for (std::size_t k = 1; k < path.size(); ++k) {
      ASSERT_TRUE(graph.hasEdge(path[k - 1], path[k]));
      for (const Neighbour& n : graph.neighbours(path[k - 1]))
        sum += n.id == path[k] ? n.weight : 0;
    }
    EXPECT_EQ(path.front(), vertex(0));
    EXPECT_EQ(path.back(), vertex(i));
    EXPECT_NEAR(sum, paths.distanceTo(vertex(i)), 1e-9);
  }
}

TEST(ShortestPaths, GrowWithTheGraph) {
  Rng rng(31);
  for (int round = 0; round < 20; ++round) {
    SpatialGraph graph = randomGraph(rng, 30, 20);
    ShortestPaths grown = shortestPaths(graph, vertex(0));
    for (int step = 0; step < 40; ++step) {
      if (step % 4 == 0) graph.addVertex({rng.uniform(), rng.uniform(), 1.0});
      const auto count = static_cast<int>(graph.vertexCount());
      const VertexId a = vertex(static_cast<std::size_t>(rng.below(count)));
      const VertexId b = vertex(static_cast<std::size_t>(rng.below(count)));
      if (a == b || graph.hasEdge(a, b)) continue;
      graph.addEdge(a, b, rng.uniform(0.1, 5.0));
      grown.takeEdge(graph, a, b);
    }
    grown.takeVertices(graph);
    const ShortestPaths anew = shortestPaths(graph, vertex(0));
    for (std::size_t i = 0; i < graph.vertexCount(); ++i) {
      ASSERT_EQ(grown.distanceTo(vertex(i)), anew.distanceTo(vertex(i))) << "vertex " << i;
      ASSERT_EQ(grown.pathTo(vertex(i)), anew.pathTo(vertex(i)));  // no two are equally long
    }
  }
}

TEST(ShortestPaths, KnowThatSomeVerticesAreNotReached) {
  SpatialGraph graph;
  const VertexId alone = graph.addVertex({0.0, 0.0, 0.0});
  const VertexId other = graph.addVertex({1.0, 0.0, 0.0});
  const ShortestPaths paths = shortestPaths(graph, alone);
  EXPECT_TRUE(paths.pathTo(other).empty());
  EXPECT_EQ(paths.pathTo(alone), std::vector<VertexId>{alone});
  EXPECT_THROW(static_cast<void>(shortestPaths(graph, vertex(7))), Precondition);
}

}  // namespace
}  // namespace spelunk::graph
