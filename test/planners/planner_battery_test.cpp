// Every planner of the factory goes through all of this.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/planners/factory.h"
#include "support/grid_world.h"

namespace spelunk::planners {
namespace {

constexpr double kResolution = 0.25;

RobotModel smallRobot() {
  RobotModel robot;
  robot.box_m = {0.8, 0.8, 0.4};
  SensorModel sensor;
  sensor.columns = 360;
  sensor.fov_vertical_deg = 60.0;
  sensor.range_max_m = 12.0;  // beyond the map's range: a miss frees its ray and hits nothing
  sensor.gain_range_m = 10.0;
  robot.sensor_models = {sensor};
  return robot;
}

class EveryPlanner : public ::testing::TestWithParam<std::string> {
 protected:
  EveryPlanner() : planner_(makePlanner(GetParam(), tree_, robot_, kResolution)) {
    map::MapParams params;
    params.resolution_m = kResolution;
    params.range_max_m = 10.0;
    params.range_min_m = 0.0;
    map_ = std::make_unique<map::OccupancyMap>(params);
    request_.home = request_.pose = {{3.0, 2.5, 2.5}, 0.0};
    request_.budget.iterations = 3000;
    request_.rng = Rng(77);
  }
  /// What the robot sees of a corridor from a few places near its beginning.
  void seeTheBeginningOf(const test::GridWorld& world) {
    for (double x = 2.0; x < 4.0; x += 0.3) {
      const Pose pose{{x, 2.5, 2.5}, 0.0};
      map_->insert(world.scan(robot_.sensor_models.front(), pose, x),
                   boxAround(pose.position, robot_.box_m));
    }
    map_->markFree(boxAround(request_.pose.position, robot_.box_m));
    request_.map = map_->freeze();
  }
  void knowAllOf(const test::GridWorld& world) {
    world.enterInto(*map_);
    request_.map = map_->freeze();
  }
  void expectFreePathFromPose(const PlanResult& result) {
    ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
    EXPECT_EQ(result.path.front().position, request_.pose.position);
    EXPECT_EQ(result.path.front().yaw, request_.pose.yaw);
    map::ConfigurationSpace space(robot_.box_m, request_.map);
    const navigation::PathCheck check =
        navigation::checkPath(space, result.path, request_.zones, request_.bounds);
    EXPECT_TRUE(check.isFree()) << toText(check.fault) << " at " << check.arc_m << " m";
  }

  RobotModel robot_ = smallRobot();
  ParamTree tree_;
  std::unique_ptr<ExplorationPlanner> planner_;
  std::unique_ptr<map::OccupancyMap> map_;
  PlanRequest request_;
};

TEST_P(EveryPlanner, ExploresALongCorridorOnAFreePath) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  const PlanResult result = planner_->plan(request_);
  expectFreePathFromPose(result);
  EXPECT_GT(lengthOf(result.path), 0.2);
  EXPECT_GT(result.stats.vertices, 1);
  EXPECT_GE(result.stats.best_gain, result.stats.gain_threshold * 0.25);
  EXPECT_GT(result.stats.total_ms, 0.0);
}

TEST_P(EveryPlanner, GetsToTheEndOfACorridorTargetByTarget) {
  const test::GridWorld world = test::corridorWorld(24.0);
  seeTheBeginningOf(world);
  double farthest_m = 0.0;
  for (int i = 1; i < 60 && farthest_m < 15.0; ++i) {
    const PlanResult result = planner_->plan(request_);
    if (result.status != PlanStatus::kOk) break;
    expectFreePathFromPose(result);
    request_.pose = result.path.back();
    request_.time_s = i;
    request_.trail.push_back({request_.time_s, request_.pose});
    planner_->report({result.memory, PathOutcome::kReached, ""});
    map_->insert(world.scan(robot_.sensor_models.front(), request_.pose, request_.time_s),
                 boxAround(request_.pose.position, robot_.box_m));
    request_.map = map_->freeze();
    farthest_m = std::max(farthest_m, request_.pose.position.x());
  }
  EXPECT_GT(farthest_m, 12.0);
}

TEST_P(EveryPlanner, RepeatsWithTheSameSeed) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  const auto other = makePlanner(GetParam(), tree_, robot_, kResolution);
  for (int i = 0; i < 3; ++i) {
    const PlanResult one = planner_->plan(request_);
    const PlanResult two = other->plan(request_);
    ASSERT_EQ(one.path.size(), two.path.size());
    for (std::size_t k = 0; k < one.path.size(); ++k) {
      EXPECT_EQ(one.path[k].position, two.path[k].position);
      EXPECT_EQ(one.path[k].yaw, two.path[k].yaw);
    }
  }
}

TEST_P(EveryPlanner, LookingAtPlansLeavesNoTrace) {
  const test::GridWorld world = test::corridorWorld(24.0);
  seeTheBeginningOf(world);
  const auto other = makePlanner(GetParam(), tree_, robot_, kResolution);
  for (int i = 1; i < 8; ++i) {
    PlanRequest look = request_;
    look.rng = Rng(static_cast<std::uint64_t>(i));
    for (int k = 0; k < 2; ++k) static_cast<void>(planner_->plan(look));
    static_cast<void>(planner_->planHome(look));
    const PlanResult looked = planner_->plan(request_);
    const PlanResult not_looked = other->plan(request_);
    ASSERT_EQ(looked.status, not_looked.status);
    ASSERT_EQ(looked.path.size(), not_looked.path.size());
    for (std::size_t n = 0; n < looked.path.size(); ++n)
      EXPECT_EQ(looked.path[n].position, not_looked.path[n].position);
    if (looked.status != PlanStatus::kOk) break;
    planner_->report({looked.memory, PathOutcome::kReached, ""});
    other->report({not_looked.memory, PathOutcome::kReached, ""});
    request_.pose = looked.path.back();
    request_.time_s = i;
    request_.trail.push_back({request_.time_s, request_.pose});
    map_->insert(world.scan(robot_.sensor_models.front(), request_.pose, request_.time_s),
                 boxAround(request_.pose.position, robot_.box_m));
    request_.map = map_->freeze();
  }
}

TEST_P(EveryPlanner, ReportOfAnotherPlannersPlanIsRefused) {
  struct Foreign : PlanMemory {};
  EXPECT_THROW(planner_->report({std::make_shared<Foreign>(), PathOutcome::kReached, ""}),
               Precondition);
}

TEST_P(EveryPlanner, WayHomeAvoidsAZoneThatReplacedAnotherOne) {
  knowAllOf(test::corridorWorld(24.0));
  for (double x = request_.home.position.x(); x <= 15.0; x += 0.5)
    request_.trail.push_back({x, {{x, 2.5, 2.5}, 0.0}});
  request_.pose = request_.trail.back().pose;
  request_.time_s = 22.0;
  const auto zoneFrom = [](double x) {
    return NoGoZone{"zone", {{x, 0.0}, {x + 1.0, 0.0}, {x + 1.0, 6.0}, {x, 6.0}}, 0.0, 6.0};
  };
  request_.zones = {zoneFrom(20.0)};
  request_.zones_revision = 1;
  planner_->report({planner_->plan(request_).memory, PathOutcome::kNone, ""});
  ASSERT_EQ(planner_->planHome(request_).status, PlanStatus::kOk);
  request_.zones = {zoneFrom(8.0)};  // right across the only way home
  request_.zones_revision = 2;
  EXPECT_EQ(planner_->planHome(request_).status, PlanStatus::kNoPath);
}

TEST_P(EveryPlanner, ReportsNothingToGainInAFullyMappedRoom) {
  knowAllOf(test::corridorWorld(12.0));
  const PlanResult result = planner_->plan(request_);
  EXPECT_EQ(result.status, PlanStatus::kNothingToGain) << result.reason;
  EXPECT_FALSE(result.reason.empty());
  EXPECT_TRUE(result.remaining.empty());
}

TEST_P(EveryPlanner, DoesNotCallExploredWhatItCouldNotLeave) {
  map_->markFree(boxAround(request_.pose.position, robot_.box_m));
  request_.map = map_->freeze();
  const PlanResult result = planner_->plan(request_);
  EXPECT_EQ(result.status, PlanStatus::kNoPath) << result.reason;
  EXPECT_NE(result.reason.find("hemmed in"), std::string::npos) << result.reason;
}

TEST_P(EveryPlanner, ReportsABlockedStart) {
  knowAllOf(test::corridorWorld(12.0));
  request_.pose.position = {0.3, 0.3, 0.3};
  EXPECT_EQ(planner_->plan(request_).status, PlanStatus::kStartBlocked);
  EXPECT_EQ(planner_->planHome(request_).status, PlanStatus::kStartBlocked);
}

TEST_P(EveryPlanner, ReportsAStartOutsideTheBoundsOrInsideAZone) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  request_.bounds.min.x() = 5.0;
  EXPECT_EQ(planner_->plan(request_).status, PlanStatus::kOutOfBounds);
  request_.bounds = {};
  request_.zones.push_back({"shaft", {{2.0, 1.0}, {4.0, 1.0}, {4.0, 4.0}, {2.0, 4.0}}});
  EXPECT_EQ(planner_->plan(request_).status, PlanStatus::kOutOfBounds);
}

TEST_P(EveryPlanner, ReportsThatTheBudgetSaysHome) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  request_.remaining_s = 0.1;
  const PlanResult result = planner_->plan(request_);
  EXPECT_EQ(result.status, PlanStatus::kBudgetSaysHome) << result.reason;
}

TEST_P(EveryPlanner, StaysOutOfNoGoZonesAndInsideTheBounds) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  request_.zones.push_back({"shaft", {{7.0, 2.2}, {9.0, 2.2}, {9.0, 4.0}, {7.0, 4.0}}});
  request_.bounds.max.x() = 20.0;
  expectFreePathFromPose(planner_->plan(request_));
}

TEST_P(EveryPlanner, FindsItsWayHomeFromTheEndOfItsPath) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  const PlanResult out = planner_->plan(request_);
  ASSERT_EQ(out.status, PlanStatus::kOk);
  request_.pose = out.path.back();
  request_.after = out.memory;
  const PlanResult back = planner_->planHome(request_);
  expectFreePathFromPose(back);
  EXPECT_EQ(back.kind, PathKind::kHome);
  EXPECT_LT(distance(back.path.back(), request_.home), 1e-9);
  EXPECT_LT(lengthOf(back.path), lengthOf(out.path) * 1.5);
}

/// The target lies back beside home: from it nobody flies to the far end first.
TEST_P(EveryPlanner, ComesHomeTheShortWayFromATargetBesideHome) {
  test::GridWorld world({36, 28, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {17.0, 5.0, 4.0}});
  world.carve({{4.0, 5.0, 1.0}, {9.0, 13.0, 4.0}});  // a side room nobody has seen
  world.enterRock(*map_);
  map_->markFree({{1.01, 1.01, 1.01}, {16.99, 4.99, 3.99}});
  request_.map = map_->freeze();
  for (double x = request_.home.position.x(); x <= 15.0; x += 0.5)
    request_.trail.push_back({x, {{x, 2.5, 2.5}, 0.0}});
  request_.pose = request_.trail.back().pose;
  request_.time_s = 22.0;
  for (int leg = 0; leg < 10 && distance(request_.pose, request_.home) >= 8.0; ++leg) {
    const PlanResult out = planner_->plan(request_);
    ASSERT_EQ(out.status, PlanStatus::kOk) << out.reason;
    request_.pose = out.path.back();
    request_.time_s += 1.0;
    planner_->report({out.memory, PathOutcome::kReached, ""});
  }
  ASSERT_LT(distance(request_.pose, request_.home), 8.0);
  const PlanResult back = planner_->planHome(request_);
  expectFreePathFromPose(back);
  EXPECT_LT(lengthOf(back.path), 10.0);
}

TEST_P(EveryPlanner, ReportsThatNoPathLeadsHome) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  request_.home.position = {35.0, 2.5, 2.5};  // never seen
  EXPECT_EQ(planner_->planHome(request_).status, PlanStatus::kNoPath);
}

TEST_P(EveryPlanner, DoesNotProposeATargetForeverThatIsRefusedEachTime) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  const PlanResult first = planner_->plan(request_);
  ASSERT_EQ(first.status, PlanStatus::kOk);
  PlanResult result = first;
  for (int i = 0; i < 60 && result.status == PlanStatus::kOk; ++i) {
    planner_->report({result.memory, PathOutcome::kRejectedUnsafe, "meets an obstacle"});
    result = planner_->plan(request_);
  }
  EXPECT_NE(result.status, PlanStatus::kOk) << "still tries after 60 refusals";
  EXPECT_FALSE(result.reason.empty());
}

TEST_P(EveryPlanner, RefusesARequestThatBreaksTheContract) {
  seeTheBeginningOf(test::corridorWorld(40.0));
  PlanRequest broken = request_;
  broken.pose.position.x() = std::nan("");
  EXPECT_THROW(static_cast<void>(planner_->plan(broken)), Precondition);
  broken = request_;
  broken.map = nullptr;
  EXPECT_THROW(static_cast<void>(planner_->plan(broken)), Precondition);
  broken = request_;
  broken.budget.iterations = 0;
  EXPECT_THROW(static_cast<void>(planner_->planHome(broken)), Precondition);
}

INSTANTIATE_TEST_SUITE_P(OfTheFactory, EveryPlanner, ::testing::ValuesIn(plannerNames()),
                         [](const auto& tested) { return tested.param; });

TEST(PlannerFactory, ListsTheKnownNamesForAnUnknownOne) {
  ParamTree tree;
  try {
    static_cast<void>(makePlanner("gbplaner", tree, smallRobot(), kResolution));
    FAIL() << "an unknown name was accepted";
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("gbplanner"), std::string::npos);
  }
}

TEST(PlannerFactory, ReadsTheShippedParametersWithoutAProblem) {
  for (const std::string& name : plannerNames()) {
    ParamTree tree;
    tree.addYamlFile(std::string(SPELUNK_SOURCE_DIR) + "/config/planners/" + name + ".yaml");
    static_cast<void>(makePlanner(name, tree, smallRobot(), kResolution));
    EXPECT_NO_THROW(tree.requireClean()) << name;
  }
}

TEST(PlannerFactory, RefusesARobotWithLegsForPlannersThatFly) {
  RobotModel walker = smallRobot();
  walker.kind = "legged";
  ParamTree tree;
  for (const char* name : {"gbplanner", "nbvp"})
    EXPECT_NO_THROW(static_cast<void>(makePlanner(name, tree, walker, kResolution)));
  for (const char* name : {"informed", "frontier_nearest", "frontier_utility", "frontier_rrt_star"})
    EXPECT_THROW(static_cast<void>(makePlanner(name, tree, walker, kResolution)), OutsideError);
}

}  // namespace
}  // namespace spelunk::planners
