#include "spelunk/graph/spatial_graph.h"

#include <gtest/gtest.h>

#include <limits>

#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

class ATriangle : public ::testing::Test {
 protected:
  SpatialGraph graph_;
  VertexId a_ = graph_.addVertex({0.0, 0.0, 0.0});
  VertexId b_ = graph_.addVertex({3.0, 0.0, 0.0});
  VertexId c_ = graph_.addVertex({0.0, 4.0, 0.0});
};

TEST_F(ATriangle, CountsAnEdgeOnceAndKnowsItFromBothEnds) {
  graph_.addEdge(a_, b_, 3.0);
  graph_.addEdge(b_, a_, 5.0);
  EXPECT_EQ(graph_.edgeCount(), 1U);
  EXPECT_TRUE(graph_.hasEdge(a_, b_));
  EXPECT_TRUE(graph_.hasEdge(b_, a_));
  EXPECT_DOUBLE_EQ(graph_.neighbours(a_).front().weight, 5.0);
  EXPECT_DOUBLE_EQ(graph_.neighbours(b_).front().weight, 5.0);
}

TEST_F(ATriangle, ForgetsARemovedEdge) {
  graph_.addEdge(a_, b_, 3.0);
  graph_.addEdge(b_, c_, 5.0);
  graph_.removeEdge(b_, a_);
  graph_.removeEdge(a_, c_);  // was never there
  EXPECT_EQ(graph_.edgeCount(), 1U);
  EXPECT_FALSE(graph_.hasEdge(a_, b_));
  EXPECT_EQ(graph_.edges(), (std::vector<std::pair<VertexId, VertexId>>{{b_, c_}}));
}

TEST_F(ATriangle, RefusesEdgesThatMakeNoSense) {
  EXPECT_THROW(graph_.addEdge(a_, a_, 1.0), Precondition);
  EXPECT_THROW(graph_.addEdge(a_, VertexId{9}, 1.0), Precondition);
  EXPECT_THROW(graph_.addEdge(a_, b_, -1.0), Precondition);
  EXPECT_THROW(graph_.addEdge(a_, b_, std::numeric_limits<double>::infinity()), Precondition);
}

TEST_F(ATriangle, FindsVerticesByDistance) {
  EXPECT_EQ(*graph_.findNearest({2.0, 0.0, 0.0}), b_);
  EXPECT_EQ(graph_.findWithin({0.0, 0.5, 0.0}, 3.6), (std::vector<VertexId>{a_, b_, c_}));
}

}  // namespace
}  // namespace spelunk::graph
