#include "spelunk/planners/baselines/nbvp_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/planners/baselines/tiled_gain.h"
#include "support/grid_world.h"

namespace spelunk::planners::baselines {
namespace {

constexpr double kResolution = 0.25;

RobotModel smallRobot() {
  RobotModel robot;
  robot.box_m = {0.8, 0.8, 0.4};
  SensorModel sensor;
  sensor.columns = 360;
  sensor.fov_vertical_deg = 60.0;
  sensor.range_max_m = 12.0;  // beyond the map's: a miss frees its ray and hits nothing
  sensor.gain_range_m = 10.0;
  robot.sensor_models = {sensor};
  return robot;
}

/// A long corridor seen from its beginning.
class InACorridor : public ::testing::Test {
 protected:
  InACorridor() : map_(mapParams()) {
    params_.max_vertices = 150;
    params_.give_up_vertices = 300;
    request_.home = request_.pose = {{3.0, 2.5, 2.5}, 0.0};
    request_.budget.iterations = 5000;
    request_.rng = Rng(5);
    for (double x = 2.0; x < 4.0; x += 0.3) {
      const Pose pose{{x, 2.5, 2.5}, 0.0};
      map_.insert(world_.scan(robot_.sensor_models.front(), pose, x),
                  boxAround(pose.position, robot_.box_m));
    }
    map_.markFree(boxAround(request_.pose.position, robot_.box_m));
    request_.map = map_.freeze();
  }
  static map::MapParams mapParams() {
    map::MapParams params;
    params.resolution_m = kResolution;
    params.range_max_m = 10.0;
    params.range_min_m = 0.0;
    return params;
  }
  [[nodiscard]] NbvpPlanner planner() const { return {params_, robot_, kResolution}; }

  /// Positions from the root to the vertex of most gain.
  static std::vector<Eigen::Vector3d> bestBranch(const NbvpPlanner& planner) {
    const GraphLayer tree = planner.graph().layers.front();
    EXPECT_EQ(tree.name, "tree");
    std::vector<std::uint32_t> parent(tree.vertices.size(), 0);
    for (const auto& [from, to] : tree.edges) parent[to] = from;
    const auto best = std::max_element(
        tree.vertices.begin(), tree.vertices.end(),
        [](const GraphVertex& a, const GraphVertex& b) { return a.gain_m3 < b.gain_m3; });
    auto at = static_cast<std::uint32_t>(best - tree.vertices.begin());
    std::vector<Eigen::Vector3d> branch{tree.vertices[at].position};
    while (at != 0) branch.push_back(tree.vertices[at = parent[at]].position);
    std::reverse(branch.begin(), branch.end());
    return branch;
  }

  NbvpParams params_;
  RobotModel robot_ = smallRobot();
  test::GridWorld world_ = test::corridorWorld(40.0);
  map::OccupancyMap map_;
  PlanRequest request_;
};

TEST_F(InACorridor, ExecutesTheFirstEdgeOfTheBranchThatGainsMost) {
  NbvpPlanner planner = this->planner();
  const PlanResult result = planner.plan(request_);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  const std::vector<Eigen::Vector3d> branch = bestBranch(planner);
  ASSERT_GE(branch.size(), 2U);
  ASSERT_EQ(result.path.size(), 2U);
  EXPECT_EQ(result.path.back().position, branch[1]);
  EXPECT_GE(lengthOf(result.path), params_.edge_length_min_m);
  EXPECT_LE(lengthOf(result.path), params_.edge_length_max_m + 1e-9);
  EXPECT_GT(branch.back().x(), 6.0) << "what is unknown lies ahead";
}

TEST_F(InACorridor, KeepsTheRestOfTheBestBranchForTheNextPlan) {
  params_.edge_length_max_m = 2.0;
  NbvpPlanner planner = this->planner();
  const PlanResult first = planner.plan(request_);
  const std::vector<Eigen::Vector3d> branch = bestBranch(planner);
  ASSERT_GE(branch.size(), 3U);
  request_.pose = first.path.back();
  request_.time_s = 2.0;
  planner.report({first.memory, PathOutcome::kReached, ""});
  request_.budget.iterations = 1;  // nothing new can grow
  const PlanResult second = planner.plan(request_);
  ASSERT_EQ(second.status, PlanStatus::kOk) << second.reason;
  EXPECT_EQ(second.path.back().position, branch[2]);
  EXPECT_EQ(bestBranch(planner).back(), branch.back());
}

TEST_F(InACorridor, WhatIsLeftOfAnEdgeIsExecutedWithTheNextOneAndNothingIsFlownBack) {
  params_.edge_length_max_m = 2.0;
  NbvpPlanner planner = this->planner();
  const PlanResult first = planner.plan(request_);
  const std::vector<Eigen::Vector3d> branch = bestBranch(planner);
  ASSERT_GE(branch.size(), 3U);
  request_.pose = poseAt(first.path, lengthOf(first.path) - 0.4);
  planner.report({first.memory, PathOutcome::kReplaced, ""});
  request_.budget.iterations = 1;
  const PlanResult rest = planner.plan(request_);
  ASSERT_EQ(rest.path.size(), 3U);
  EXPECT_EQ(rest.path[1].position, branch[1]);
  EXPECT_EQ(rest.path[2].position, branch[2]);
  planner.report({rest.memory, PathOutcome::kReplaced, ""});
  request_.pose = poseAt(rest.path, 0.4 + 0.3);  // beyond the first corner
  const PlanResult beyond = planner.plan(request_);
  ASSERT_EQ(beyond.status, PlanStatus::kOk);
  EXPECT_EQ(beyond.path[1].position, branch[2]) << "the corner behind it is passed";
}

TEST_F(InACorridor, GrowsToItsSizeWhileThereIsSomethingToGain) {
  params_.edge_length_min_m = 0.1;
  const PlanResult result = planner().plan(request_);
  EXPECT_EQ(result.stats.vertices, params_.max_vertices);
  EXPECT_EQ(result.stats.edges, params_.max_vertices - 1);
  EXPECT_GE(result.stats.best_gain, params_.gain_min_m3 * 0.1);
}

TEST_F(InACorridor, EndsExplorationOnlyAfterTheLargerTreeHasSeenNothing) {
  params_.edge_length_min_m = 0.1;
  params_.gain_min_m3 = 1e5;
  request_.budget.iterations = 100000;
  const PlanResult result = planner().plan(request_);
  EXPECT_EQ(result.status, PlanStatus::kNothingToGain);
  EXPECT_EQ(result.stats.vertices, params_.give_up_vertices);
  EXPECT_NE(result.reason.find("300 nodes"), std::string::npos) << result.reason;
}

TEST_F(InACorridor, GainsOfTheTreeAreThoseOfTheFormula) {
  params_.max_vertices = 40;
  NbvpPlanner planner = this->planner();
  static_cast<void>(planner.plan(request_));
  const GraphLayer tree = planner.graph().layers.front();
  const map::GainEvaluator evaluator(robot_.sensor_models, kResolution, map::GainCounting::kCone,
                                     params_.cone_depth_m);
  const auto credible =
      map::CredibleMap({params_.closing_height_m, params_.growth_m}).of(request_.map);
  const AxisAlignedBox known = credible->knownBounds();
  const Eigen::Vector3d reach(evaluator.reach(), evaluator.reach(), 0.5 * kResolution);
  const map::LocalWindow window(*credible, {known.min - reach, known.max + reach});
  std::vector<double> length(tree.vertices.size(), 0.0);
  for (const auto& [parent, child] : tree.edges) {
    const Eigen::Vector3d edge = tree.vertices[child].position - tree.vertices[parent].position;
    length[child] = length[parent] + edge.norm();
    const double seen = evaluator
                            .evaluate(window, tree.vertices[child].position,
                                      std::atan2(edge.y(), edge.x()), request_.bounds)
                            .unknown_m3;
    const double counted = seen < params_.gain_min_m3 ? 0.0 : seen;
    EXPECT_NEAR(tree.vertices[child].gain_m3,
                tree.vertices[parent].gain_m3 +
                    counted * std::exp(-params_.distance_weight * length[child]),
                1e-6 * (1.0 + tree.vertices[child].gain_m3));
  }
}

TEST_F(InACorridor, SamplesOfTheWholeBoxAreOftenLostInRock) {
  const PlanStats explored = planner().plan(request_).stats;
  params_.samples = "box";
  NbvpPlanner planner = this->planner();
  const PlanResult result = planner.plan(request_);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  const auto lost = [](const PlanStats& stats) {
    return static_cast<double>(stats.rejected_occupied + stats.rejected_unknown) / stats.samples;
  };
  EXPECT_GT(lost(result.stats), lost(explored));
}

TEST_F(InACorridor, ANodeOfACameraLooksAnywhere) {
  SensorModel& camera = robot_.sensor_models.front();
  camera.fov_horizontal_deg = 90.0;
  params_.gain_min_m3 = 1.0;
  const PlanResult result = planner().plan(request_);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  const Eigen::Vector3d edge = result.path.back().position - request_.pose.position;
  EXPECT_GT(std::abs(wrapAngle(result.path.back().yaw - std::atan2(edge.y(), edge.x()))), 0.01);
}

TEST_F(InACorridor, KeepsARobotWithLegsAtItsHeightAboveTheGround) {
  robot_.kind = "legged";
  robot_.ride_height_m = 0.6;
  robot_.box_m = {0.8, 0.8, 0.5};
  request_.home.position.z() = request_.pose.position.z() = 1.0 + robot_.ride_height_m;
  for (double x = 2.0; x < 4.0; x += 0.3) {
    const Pose pose{{x, 2.5, 1.6}, 0.0};
    map_.insert(world_.scan(robot_.sensor_models.front(), pose, x),
                boxAround(pose.position, robot_.box_m));
  }
  map_.markFree(boxAround(request_.pose.position, robot_.box_m));
  request_.map = map_.freeze();
  NbvpPlanner planner = this->planner();
  const PlanResult result = planner.plan(request_);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  const GraphLayer tree = planner.graph().layers.front();
  EXPECT_GT(tree.vertices.size(), 10U);
  for (const GraphVertex& vertex : tree.vertices)
    EXPECT_NEAR(vertex.position.z(), 1.0 + robot_.ride_height_m, kResolution);
}

TEST(NbvpParams, NamesEveryRuleThatIsBroken) {
  NbvpParams params;
  EXPECT_TRUE(params.problems().empty());
  params.give_up_vertices = params.max_vertices - 1;
  params.edge_length_min_m = params.edge_length_max_m;
  params.samples = "everywhere";
  EXPECT_EQ(params.problems().size(), 3U);
}

TEST(TiledGain, CountsWhatOneWindowRoundEverythingDoes) {
  map::MapParams params;
  params.resolution_m = 0.5;
  params.range_max_m = 10.0;
  map::OccupancyMap map(params);
  Rng rng(3);
  for (int k = 0; k < 60; ++k) {  // halls with rock in them, over several tiles
    const Eigen::Vector3d centre(rng.uniform(-90, 90), rng.uniform(-90, 90), rng.uniform(0, 3));
    map.markFree(boxAround(centre, {rng.uniform(4, 30), rng.uniform(4, 30), 3.0}));
  }
  const auto frozen = map.freeze();
  const map::GainEvaluator evaluator(smallRobot().sensor_models, params.resolution_m,
                                     map::GainCounting::kCone);
  const AxisAlignedBox bounds{{-80.0, -80.0, -1.0}, {80.0, 80.0, 4.0}};
  map::KeptWindow kept(Eigen::Vector3d(7.0, 3.0, 1.0));
  TiledGain whole(frozen, evaluator, bounds, kept);
  TiledGain tiled(frozen, evaluator, bounds, kept, 0.0);
  const AxisAlignedBox known = frozen->knownBounds();
  const Eigen::Vector3d reach(evaluator.reach(), evaluator.reach(), 0.25);
  const map::LocalWindow window(*frozen, {known.min - reach, known.max + reach});
  int seeing = 0;
  for (int k = 0; k < 300; ++k) {
    const Pose pose{{rng.uniform(-80, 80), rng.uniform(-80, 80), rng.uniform(0, 3)},
                    rng.uniform(-3, 3)};
    const double once = evaluator.evaluate(window, pose.position, pose.yaw, bounds).unknown_m3;
    EXPECT_NEAR(tiled.visibleFrom(pose), once, 1e-6);
    EXPECT_NEAR(whole.visibleFrom(pose), once, 1e-6);
    seeing += once > 0.0 ? 1 : 0;
  }
  EXPECT_GT(seeing, 100);
  EXPECT_EQ(whole.tiles(), 0U);
  EXPECT_GT(tiled.tiles(), 4U);
  EXPECT_LE(tiled.tiles(), 16U);
}

}  // namespace
}  // namespace spelunk::planners::baselines
