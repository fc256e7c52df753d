#include "spelunk/planners/informed/graph_growth.h"

#include <gtest/gtest.h>

#include "spelunk/planners/informed/scouting.h"
#include "support/frontier_world.h"

namespace spelunk::planners::informed {
namespace {

using graph::VertexId;

/// A robot that has flown along a corridor, looking around at every metre.
class FlownCorridor : public ::testing::Test {
 protected:
  FlownCorridor()
      : params_(test::seeingFourMetres()),
        world_(test::corridorWorld(40.0)),
        view_(world_.robot, test::FrontierWorld::kResolution_m, {4.0, {0.0, 0.0}}),
        navigator_({}),
        boxes_(world_.robot.box_m),
        growth_(params_) {
    world_.request.home.position = {3.0, 2.5, 2.5};
    flyTo(3.0, 3.0);
  }
  void flyTo(double from_x, double to_x) {
    for (double x = from_x; x <= to_x + 1e-9; x += 1.0) {
      world_.lookFrom({x, 2.5, 2.5});
      world_.request.trail.push_back({++now_s_, world_.request.pose});
    }
    world_.request.time_s = now_s_;
    view_.look(world_.request.map);
  }
  VertexId grow() {
    KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
    const FrontierSurvey survey(view_, world_.request, params_);
    return growth_.grow(world_.request, world_.request.pose.position, survey, space);
  }
  const ReachabilityGraph& graph() { return growth_.graph(); }

  InformedParams params_;
  test::FrontierWorld world_;
  FrontierView view_;
  navigation::Navigator navigator_;
  map::ConfigurationSpace boxes_;
  GraphGrowth growth_;
  double now_s_ = 0.0;
};

TEST_F(FlownCorridor, BeginsWithHomeAlone) {
  EXPECT_EQ(grow(), ReachabilityGraph::home());
  EXPECT_EQ(grow(), ReachabilityGraph::home()) << "there is a vertex at the root already";
  EXPECT_EQ(graph().graph().vertexCount(), 1U);
  EXPECT_FALSE(graph().labelOf(ReachabilityGraph::home()).is_explored);
}

TEST_F(FlownCorridor, HasVerticesAlongTheWayWhereTheBoxHoldsFrontierAndOneAtTheEnd) {
  grow();
  flyTo(4.0, 14.0);
  const VertexId end = grow();
  EXPECT_DOUBLE_EQ(graph().graph().position(end).x(), 14.0);
  const graph::FoundPath home = graph().cheapestPath(end, ReachabilityGraph::home());
  ASSERT_TRUE(home.isFound());
  EXPECT_NEAR(home.length, 11.0, 0.5);
  for (const VertexId vertex : graph().vertices()) {
    const bool is_end = vertex == end || vertex == ReachabilityGraph::home();
    const bool is_frontier = !graph().labelOf(vertex).frontier.empty();
    EXPECT_TRUE(is_end || is_frontier);
  }
  EXPECT_TRUE(graph().labelOf(ReachabilityGraph::home()).is_explored);
  EXPECT_FALSE(graph().labelOf(end).is_explored);
}

TEST_F(FlownCorridor, IsTheSameGraphForTheSameFlight) {
  FlownCorridor::flyTo(4.0, 12.0);
  grow();
  GraphGrowth other(params_);
  KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
  const FrontierSurvey survey(view_, world_.request, params_);
  other.grow(world_.request, world_.request.pose.position, survey, space);
  EXPECT_EQ(other.graph().graph().edges(), graph().graph().edges());
  EXPECT_EQ(other.graph().graph().vertexCount(), graph().graph().vertexCount());
}

TEST_F(FlownCorridor, LeadsABlockedWayAnotherWayOrNone) {
  grow();
  flyTo(4.0, 10.0);
  const VertexId end = grow();
  {
    KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
    const graph::Polyline way = growth_.freeWay(end, ReachabilityGraph::home(), space);
    EXPECT_TRUE(space.isFree(way));
    EXPECT_NEAR(graph::lengthOf(way), 7.0, 0.5);
  }
  world_.request.zones.push_back({"pillar", {{6.0, 1.0}, {6.5, 1.0}, {6.5, 2.6}, {6.0, 2.6}}});
  growth_.forgetChecksNear({6.0, 2.5, 2.5}, 20.0);
  {
    KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
    const graph::Polyline way = growth_.freeWay(end, ReachabilityGraph::home(), space);
    ASSERT_FALSE(way.empty()) << "there is room beside the pillar";
    EXPECT_TRUE(space.isFree(way));
  }
  world_.request.zones.push_back({"wall", {{7.0, 0.0}, {7.5, 0.0}, {7.5, 5.0}, {7.0, 5.0}}});
  growth_.forgetChecksNear({7.0, 2.5, 2.5}, 20.0);
  KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
  EXPECT_TRUE(growth_.freeWay(end, ReachabilityGraph::home(), space).empty());
}

TEST_F(FlownCorridor, IsJoinedToHomeAgainOnceAWayIsFree) {
  grow();
  flyTo(4.0, 10.0);
  const VertexId end = grow();
  world_.request.zones.push_back({"wall", {{7.0, 0.0}, {7.5, 0.0}, {7.5, 5.0}, {7.0, 5.0}}});
  growth_.forgetChecksNear({7.0, 2.5, 2.5}, 20.0);
  {
    KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
    ASSERT_TRUE(growth_.freeWay(end, ReachabilityGraph::home(), space).empty());
    growth_.rejoinHome(end, space);
    EXPECT_FALSE(graph().cheapestPath(end, ReachabilityGraph::home()).isFound())
        << "the wall still stands";
  }
  world_.request.zones.clear();
  KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
  growth_.rejoinHome(end, space);
  const graph::Polyline way = growth_.freeWay(end, ReachabilityGraph::home(), space);
  ASSERT_FALSE(way.empty());
  EXPECT_TRUE(space.isFree(way));
  EXPECT_LT(graph::lengthOf(way), 12.0);
}

TEST_F(FlownCorridor, TakesUpASavedGraph) {
  grow();
  flyTo(4.0, 10.0);
  grow();
  GraphGrowth other(params_);
  other.restore(graph().layer());
  EXPECT_EQ(other.graph().graph().edgeCount(), graph().graph().edgeCount());
}

TEST_F(FlownCorridor, ScoutingAddsVerticesForFrontierInNoBox) {
  InformedParams near_sighted = params_;
  near_sighted.range_m = 1.5;  // the sensor sees 6 m
  GraphGrowth growth(near_sighted);
  KnownSpace space(world_.request, world_.robot, navigator_, boxes_);
  const FrontierSurvey survey(view_, world_.request, near_sighted);
  const VertexId home = growth.grow(world_.request, {3.0, 2.5, 2.5}, survey, space);
  Scouting scouting(near_sighted);
  const int found = scouting.scout(home, 2, growth, view_, world_.request, space);
  ASSERT_GE(found, 1);
  survey.refresh(growth.graph());
  const VertexId scouted{1};
  EXPECT_GT(growth.graph().graph().position(scouted).x(), 4.5);
  EXPECT_FALSE(growth.graph().labelOf(scouted).is_explored);
  EXPECT_TRUE(growth.graph().cheapestPath(home, scouted).isFound());
  EXPECT_EQ(space.free().at(growth.graph().graph().position(scouted)), Rejection::kNone);
}

}  // namespace
}  // namespace spelunk::planners::informed
