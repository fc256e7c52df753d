#include "spelunk/planners/informed/reachability_graph.h"

#include <gtest/gtest.h>

#include "spelunk/common/contract.h"

namespace spelunk::planners::informed {
namespace {

using graph::VertexId;

const Eigen::Vector3d kHome(0.0, 0.0, 1.0);
const Eigen::Vector3d kBend(4.0, 0.0, 1.0);
const Eigen::Vector3d kEnd(4.0, 4.0, 1.0);

/// Home, a bend and an end, joined by straight ways.
struct Bend {
  ReachabilityGraph graph{4.0};
  VertexId home = graph.insertVertex(kHome);
  VertexId bend = graph.insertVertex(kBend);
  VertexId end = graph.insertVertex(kEnd);
  Bend() {
    graph.insertEdge(home, bend, {kHome, kBend});
    graph.insertEdge(end, bend, {kEnd, kBend});
  }
};

TEST(ReachabilityGraph, CostsAreLengthsOfWays) {
  Bend known;
  const Eigen::Vector3d aside(0.0, 3.0, 1.0);
  const VertexId far = known.graph.insertVertex({0.0, 6.0, 1.0});
  known.graph.insertEdge(known.home, far, {kHome, aside, {0.0, 6.0, 1.0}});
  EXPECT_DOUBLE_EQ(known.graph.cheapestPath(far, known.end).length, 6.0 + 4.0 + 4.0);
  EXPECT_EQ(known.graph.lineOf(known.graph.cheapestPath(far, known.end)),
            (graph::Polyline{{0.0, 6.0, 1.0}, aside, kHome, kBend, kEnd}));
}

TEST(ReachabilityGraph, WaysReadTheSameInBothDirections) {
  Bend known;
  EXPECT_EQ(known.graph.wayOf(known.bend, known.end), (graph::Polyline{kBend, kEnd}));
  EXPECT_EQ(known.graph.wayOf(known.end, known.bend), (graph::Polyline{kEnd, kBend}));
}

TEST(ReachabilityGraph, KeepsTheCheaperOfTwoWays) {
  Bend known;
  const Eigen::Vector3d detour(2.0, 3.0, 1.0);
  known.graph.insertEdge(known.home, known.bend, {kHome, detour, kBend});
  EXPECT_EQ(known.graph.wayOf(known.home, known.bend).size(), 2U);
  known.graph.removeEdge(known.home, known.bend);
  EXPECT_FALSE(known.graph.cheapestPath(known.home, known.end).isFound());
  known.graph.insertEdge(known.home, known.bend, {kHome, detour, kBend});
  known.graph.insertEdge(known.bend, known.home, {kBend, kHome});
  EXPECT_DOUBLE_EQ(known.graph.cheapestPath(known.home, known.end).length, 8.0);
}

TEST(ReachabilityGraph, RefusesAWayThatEndsElsewhere) {
  Bend known;
  EXPECT_THROW(known.graph.insertEdge(known.home, known.end, {kHome, kBend}), Precondition);
  EXPECT_THROW(known.graph.insertEdge(known.home, known.end, {}), Precondition);
  EXPECT_THROW(static_cast<void>(known.graph.wayOf(known.home, known.end)), Precondition);
}

TEST(ReachabilityGraph, RanksUnexploredVerticesByTheWayToThem) {
  Bend known;
  const VertexId near_but_apart = known.graph.insertVertex({0.5, 0.0, 1.0});
  std::vector<RankedVertex> ranked = known.graph.rank(known.end);
  ASSERT_EQ(ranked.size(), 3U) << "what no edge leads to is left out";
  EXPECT_EQ(ranked[0].vertex, known.end);
  EXPECT_EQ(ranked[1].vertex, known.bend);
  EXPECT_EQ(ranked[2].vertex, known.home);
  EXPECT_DOUBLE_EQ(ranked[2].distance_m, 8.0);
  known.graph.update(known.bend).is_explored = true;
  known.graph.insertEdge(near_but_apart, known.home, {{0.5, 0.0, 1.0}, kHome});
  ranked = known.graph.rank(known.end);
  ASSERT_EQ(ranked.size(), 3U);
  EXPECT_EQ(ranked[1].vertex, known.home);
  EXPECT_EQ(ranked[2].vertex, near_but_apart);
}

TEST(ReachabilityGraph, BoxesAreTwiceTheRangeWide) {
  const Bend known;
  const AxisAlignedBox box = known.graph.boxOf(known.end);
  EXPECT_TRUE(box.size().isApprox(Eigen::Vector3d::Constant(8.0)));
  EXPECT_TRUE((0.5 * (box.min + box.max)).isApprox(kEnd));
}

TEST(ReachabilityGraph, ComesBackFromItsLayer) {
  Bend known;
  known.graph.update(known.bend).is_explored = true;
  const GraphLayer layer = known.graph.layer();
  EXPECT_EQ(layer.name, "reachability");
  EXPECT_TRUE(layer.vertices[0].is_frontier);
  EXPECT_FALSE(layer.vertices[1].is_frontier);
  ReachabilityGraph other(4.0);
  other.restore(layer);
  EXPECT_DOUBLE_EQ(other.cheapestPath(known.home, known.end).length, 8.0);
  EXPECT_EQ(other.graph().vertexCount(), 3U);
}

}  // namespace
}  // namespace spelunk::planners::informed
