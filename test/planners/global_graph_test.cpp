#include "spelunk/planners/shared/global_graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/planners/gbplanner/global_search.h"

namespace spelunk::planners::gbplanner {
namespace {

GlobalGraphLimits withWideConnections() {
  GlobalGraphLimits limits;
  limits.connect_radius_m = 4.5;
  return limits;
}

/// Open space with an optional wall at x = wall_x for y > 0.
class AnOpenPlain : public ::testing::Test {
 protected:
  [[nodiscard]] FreeSpace space() const {
    return {[this](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
              const bool crosses = (a.x() < wall_x_) != (b.x() < wall_x_);
              return crosses && std::max(a.y(), b.y()) > 0.0 ? map::Occupancy::kOccupied
                                                             : map::Occupancy::kFree;
            },
            {1.0, 1.0, 0.4},
            bounds_,
            zones_};
  }
  void addLine(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    global_.addPath({from, to}, space());
  }

  double wall_x_ = 1e9;
  AxisAlignedBox bounds_;
  std::vector<NoGoZone> zones_;
  GlobalGraph global_{withWideConnections()};
};

TEST_F(AnOpenPlain, HasHomeFirst) {
  global_.setHome({0, 0, 1});
  EXPECT_THROW(global_.setHome({1, 0, 1}), Precondition);
  EXPECT_EQ(global_.graph().position(GlobalGraph::home()), Eigen::Vector3d(0, 0, 1));
}

TEST_F(AnOpenPlain, JoinsAPathToWhatIsNearAndDensifies) {
  global_.setHome({0, 0, 1});
  addLine({0, 0, 1}, {10, 0, 1});
  EXPECT_EQ(global_.graph().vertexCount(), 6U);  // home is used again, then every 2 m
  EXPECT_GT(global_.graph().edgeCount(), 5U);
  const graph::Polyline way =
      global_.findFreePath(graph::VertexId{5}, GlobalGraph::home(), space());
  EXPECT_NEAR(graph::lengthOf(way), 10.0, 1e-9);
}

TEST_F(AnOpenPlain, AddsNothingNewForTheSamePathAgain) {
  global_.setHome({0, 0, 1});
  addLine({0, 0, 1}, {10, 0, 1});
  addLine({0, 0.1, 1}, {10, 0.1, 1});
  EXPECT_EQ(global_.graph().vertexCount(), 6U);
}

TEST_F(AnOpenPlain, FindsAnotherWayWhenAnEdgeIsBlockedLater) {
  global_.setHome({0, 2, 1});
  addLine({0, 2, 1}, {12, 2, 1});
  addLine({0, 2, 1}, {0, -2, 1});
  addLine({0, -2, 1}, {12, -2, 1});
  addLine({12, -2, 1}, {12, 2, 1});
  const graph::VertexId goal = *global_.graph().findNearest({12, 2, 1});
  EXPECT_NEAR(graph::lengthOf(global_.findFreePath(goal, GlobalGraph::home(), space())), 12.0, 1.0);
  wall_x_ = 6.1;
  global_.forgetChecksNear({6, 0, 1}, 100.0);
  const graph::Polyline around = global_.findFreePath(goal, GlobalGraph::home(), space());
  ASSERT_FALSE(around.empty());
  EXPECT_GT(graph::lengthOf(around), 14.0);
  for (std::size_t i = 1; i < around.size(); ++i)
    EXPECT_TRUE(space().isFree(around[i - 1], around[i]));
}

TEST_F(AnOpenPlain, FindsNoWayWhereThereIsNone) {
  wall_x_ = 6.1;
  global_.setHome({0, 2, 1});
  addLine({8, 2, 1}, {12, 2, 1});
  EXPECT_TRUE(global_.findFreePath(graph::VertexId{1}, GlobalGraph::home(), space()).empty());
}

TEST_F(AnOpenPlain, RemembersWhatWasFlownEvenWhereItLooksBlocked) {
  wall_x_ = 1.0;
  global_.setHome({0, 2, 1});
  global_.addFlown({2, 2, 1}, space());
  EXPECT_TRUE(global_.graph().hasEdge(graph::VertexId{0}, graph::VertexId{1}));
}

TEST_F(AnOpenPlain, ComesBackFromItsLayer) {
  global_.setHome({0, 0, 1});
  addLine({0, 0, 1}, {10, 0, 1});
  global_.markFrontier(graph::VertexId{5}, 33.0);
  GlobalGraph restored{GlobalGraphLimits{}};
  restored.restore(global_.layer());
  EXPECT_EQ(restored.graph().edges(), global_.graph().edges());
  ASSERT_EQ(restored.frontiers().size(), 1U);
  EXPECT_DOUBLE_EQ(restored.frontiers().front().gain_m3, 33.0);
}

TEST_F(AnOpenPlain, AFrontierThatPromisesMuchMoreTakesThePlaceOfOneNearBy) {
  global_.setHome({0, 0, 1});
  addLine({0, 0, 1}, {10, 0, 1});
  global_.markFrontier(graph::VertexId{4}, 30.0);
  global_.markFrontier(graph::VertexId{5}, 50.0);  // 2 m away, not twice as good
  ASSERT_EQ(global_.frontiers().size(), 1U);
  EXPECT_DOUBLE_EQ(global_.frontiers().front().gain_m3, 30.0);
  global_.markFrontier(graph::VertexId{5}, 70.0);
  ASSERT_EQ(global_.frontiers().size(), 1U);
  EXPECT_DOUBLE_EQ(global_.frontiers().front().gain_m3, 70.0);
  global_.frontiers().front().closed_because = "tried";
  global_.markFrontier(graph::VertexId{4}, 500.0);
  EXPECT_EQ(global_.frontiers().size(), 1U) << "a closed one is not opened by another name";
}

class TwoFrontiers : public AnOpenPlain {
 protected:
  TwoFrontiers() {
    global_.setHome({0, 0, 1});
    addLine({0, 0, 1}, {10, 0, 1});
    addLine({0, 0, 1}, {-30, 0, 1});
    near_ = *global_.graph().findNearest({10, 0, 1});
    far_ = *global_.graph().findNearest({-30, 0, 1});
    global_.markFrontier(near_, 40.0);
    global_.markFrontier(far_, 50.0);
    query_.current = GlobalGraph::home();
    query_.remaining_s = 500.0;
    query_.speed_mps = 2.0;
    params_.frontier_gain_m3 = 12.0;  // both promise more
    query_.frontier_gain_m3 = params_.frontier_gain_m3;
    query_.gain_at = [this](const Eigen::Vector3d& at) { return at.x() > 0.0 ? near_gain_ : 50.0; };
  }
  [[nodiscard]] GlobalPlan plan() {
    return planGlobally(global_, query_, space(), tried_, params_);
  }

  graph::VertexId near_{};
  graph::VertexId far_{};
  double near_gain_ = 40.0;
  GlobalQuery query_;
  GbPlannerParams params_;
  TriedTargets tried_{3.0};
};

TEST_F(TwoFrontiers, FrontiersBelowTheGainAskedForWaitForAnotherPass) {
  query_.frontier_gain_m3 = 45.0;
  EXPECT_NEAR(plan().target->x(), -30.0, 1e-9) << "the near one promises 40";
  query_.frontier_gain_m3 = 60.0;
  EXPECT_TRUE(plan().path.empty());
  EXPECT_EQ(global_.frontiers().size(), 2U) << "none is forgotten";
}

TEST_F(TwoFrontiers, PrefersTheNearOne) {
  params_.global_distance_weight = 0.03;
  EXPECT_TRUE(plan().target->isApprox(Eigen::Vector3d(10, 0, 1)));
}

TEST_F(TwoFrontiers, BelievesASmallGainLessThanInProportion) {
  params_.global_distance_weight = 0.02;
  EXPECT_GT(40.0 * std::exp(0.02 * 20.0), 50.0) << "by gains alone the near one would be better";
  EXPECT_TRUE(plan().target->isApprox(Eigen::Vector3d(-30, 0, 1)));
  params_.gain_threshold_m3 = 40.0;
  EXPECT_TRUE(plan().target->isApprox(Eigen::Vector3d(10, 0, 1)));
}

TEST_F(TwoFrontiers, DropsTheNearOneWhenItsGainIsGone) {
  params_.global_distance_weight = 0.03;
  near_gain_ = 1.0;
  EXPECT_TRUE(plan().target->isApprox(Eigen::Vector3d(-30, 0, 1)));
  EXPECT_EQ(global_.frontiers().size(), 1U);
}

TEST_F(TwoFrontiers, LeavesOutWhatTheEnduranceDoesNotAllow) {
  near_gain_ = 1.0;
  query_.remaining_s = 30.0;  // one way to the far one takes 15 s and more
  const GlobalPlan planned = plan();
  EXPECT_TRUE(planned.path.empty());
  EXPECT_EQ(planned.out_of_budget, 1);
}

TEST_F(TwoFrontiers, OnlyOnesOfFullGainCountAsLeftBehind) {
  params_.frontier_gain_m3 = 45.0;
  query_.frontier_gain_m3 = kMinorShare * params_.frontier_gain_m3;
  query_.remaining_s = 1.0;
  const GlobalPlan planned = plan();
  EXPECT_TRUE(planned.path.empty());
  EXPECT_EQ(planned.out_of_budget, 1) << "the near one promises 40";
}

TEST_F(TwoFrontiers, ClosesATargetThatFailedAndSaysWhy) {
  tried_.note({10, 0, 1}, PathOutcome::kRejectedBudget, "no way home fits", 0.0);
  EXPECT_TRUE(plan().target->isApprox(Eigen::Vector3d(-30, 0, 1)));
  EXPECT_EQ(global_.frontiers().front().closed_because, "tried and given up: no way home fits");
}

}  // namespace
}  // namespace spelunk::planners::gbplanner
