// Every planner of the factory goes through all of this with every robot, as config/ ships them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "spelunk/common/contract.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/planners/factory.h"
#include "support/grid_world.h"

namespace spelunk::planners {
namespace {

constexpr double kFloor_m = 1.0;

/// One robot and one planner as config/ ships them.
struct Shipped {
  std::string robot;
  std::string planner;
};

void PrintTo(const Shipped& shipped, std::ostream* out) {
  *out << shipped.planner << " with robot " << shipped.robot;
}

mission::RunConfig load(const Shipped& shipped) {
  mission::RunChoice choice;
  choice.share_dir = SPELUNK_SOURCE_DIR;
  choice.robot = shipped.robot;
  choice.planner = shipped.planner;
  return mission::loadRunConfig(choice);
}

std::vector<std::string> shippedRobots() {
  std::vector<std::string> names;
  const std::string folder = std::string(SPELUNK_SOURCE_DIR) + "/config/robots";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Planners that plan for robots with legs, too.
bool plansForLegs(const std::string& planner) {
  return planner == "gbplanner" || planner == "nbvp";
}

std::vector<Shipped> everyShipped() {
  std::vector<Shipped> all;
  for (const std::string& robot : shippedRobots())
    for (const std::string& planner : plannerNames())
      if (plansForLegs(planner) || kindOf(load({robot, planner}).robot) == RobotKind::kAerial)
        all.push_back({robot, planner});
  return all;
}

/// A corridor along x, and beside its far end a hall: from the beginning of the corridor no sensor
/// sees round the corner, however far it reaches.
test::GridWorld corridorToHall() {
  test::GridWorld world({50, 42, 10}, 0.5);
  world.carve({{1.0, 1.0, kFloor_m}, {13.0, 4.0, 4.0}});
  world.carve({{10.0, 4.0, kFloor_m}, {13.0, 6.0, 4.0}});
  world.carve({{2.0, 6.0, kFloor_m}, {24.0, 20.0, 4.0}});
  return world;
}

class EveryPlanner : public ::testing::TestWithParam<Shipped> {
 protected:
  EveryPlanner() : planner_(make()) {
    map::MapParams params = config_.map;
    params.range_min_m = 0.0;  // GridWorld enters rock by returns from right beside it
    map_ = std::make_unique<map::OccupancyMap>(params);
    request_.home = request_.pose = at(3.0, 2.5);
    request_.budget.iterations = config_.mission.max_samples;
    request_.rng = Rng(77);
  }
  [[nodiscard]] std::unique_ptr<ExplorationPlanner> make() {
    return makePlanner(config_.planner, config_.tree, robot_, config_.map.resolution_m);
  }
  /// Where the middle of the robot's box is when it stands or flies there.
  [[nodiscard]] Pose at(double x, double y) const {
    const bool walks = kindOf(robot_) == RobotKind::kLegged;
    return {{x, y, walks ? kFloor_m + robot_.ride_height_m + robot_.box_lift_m : 2.5}, 0.0};
  }
  void look(const test::GridWorld& world, const Pose& middle, double time_s) {
    Pose base = middle;
    base.position.z() -= robot_.box_lift_m;
    for (const SensorModel& sensor : robot_.sensor_models)
      map_->insert(world.scan(sensor, base, time_s), boxAround(middle.position, robot_.box_m));
  }
  /// What the robot sees of a world from a few places near its beginning.
  void seeTheBeginningOf(const test::GridWorld& world) {
    for (double x = 2.0; x < 4.0; x += 0.3) look(world, at(x, 2.5), x);
    map_->markFree(boxAround(request_.pose.position, robot_.box_m));
    request_.map = map_->freeze();
  }
  void knowAllOf(const test::GridWorld& world) {
    world.enterInto(*map_);
    request_.map = map_->freeze();
  }
  /// The robot stands at the end of a path and has looked round.
  void flyTo(const Pose& pose, const test::GridWorld& world, double time_s) {
    request_.pose = pose;
    request_.time_s = time_s;
    request_.trail.push_back({request_.time_s, request_.pose});
    look(world, pose, time_s);
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

  mission::RunConfig config_ = load(GetParam());
  const RobotModel& robot_ = config_.robot;
  std::unique_ptr<ExplorationPlanner> planner_;
  std::unique_ptr<map::OccupancyMap> map_;
  PlanRequest request_;
};

TEST_P(EveryPlanner, ExploresALongCorridorOnAFreePath) {
  seeTheBeginningOf(corridorToHall());
  const PlanResult result = planner_->plan(request_);
  expectFreePathFromPose(result);
  EXPECT_GT(lengthOf(result.path), 0.2);
  EXPECT_GT(result.stats.vertices, 1);
  const bool takes_every_frontier =
      GetParam().planner == "frontier_nearest" || GetParam().planner == "frontier_rrt_star";
  EXPECT_EQ(result.stats.gain_threshold > 0.0, !takes_every_frontier);
  EXPECT_EQ(result.stats.best_gain > 0.0, !takes_every_frontier);
  EXPECT_GT(result.stats.total_ms, 0.0);
}

TEST_P(EveryPlanner, SeesTheFarCornerOfAHallTargetByTarget) {
  const test::GridWorld world = corridorToHall();
  seeTheBeginningOf(world);
  const auto seesTheCorner = [&] {
    return request_.map->at(at(22.0, 18.0).position) == map::Occupancy::kFree;
  };
  ASSERT_FALSE(seesTheCorner());
  for (int i = 1; i < 120 && !seesTheCorner(); ++i) {
    const PlanResult result = planner_->plan(request_);
    ASSERT_EQ(result.status, PlanStatus::kOk) << "plan " << i << ": " << result.reason;
    expectFreePathFromPose(result);
    planner_->report({result.memory, PathOutcome::kReached, ""});
    flyTo(result.path.back(), world, i);
  }
  EXPECT_TRUE(seesTheCorner());
}

TEST_P(EveryPlanner, RepeatsWithTheSameSeed) {
  seeTheBeginningOf(corridorToHall());
  const auto other = make();
  for (int i = 0; i < 3; ++i) {
    const PlanResult one = planner_->plan(request_);
    const PlanResult two = other->plan(request_);
    ASSERT_EQ(one.status, PlanStatus::kOk) << one.reason;
    ASSERT_EQ(one.path.size(), two.path.size());
    for (std::size_t k = 0; k < one.path.size(); ++k) {
      EXPECT_EQ(one.path[k].position, two.path[k].position);
      EXPECT_EQ(one.path[k].yaw, two.path[k].yaw);
    }
  }
}

TEST_P(EveryPlanner, LookingAtPlansLeavesNoTrace) {
  const test::GridWorld world = corridorToHall();
  seeTheBeginningOf(world);
  const auto other = make();
  for (int i = 1; i < 8; ++i) {
    PlanRequest look = request_;
    look.rng = Rng(static_cast<std::uint64_t>(i));
    for (int k = 0; k < 2; ++k) static_cast<void>(planner_->plan(look));
    static_cast<void>(planner_->planHome(look));
    const PlanResult looked = planner_->plan(request_);
    const PlanResult not_looked = other->plan(request_);
    ASSERT_EQ(looked.status, not_looked.status);
    ASSERT_TRUE(i > 1 || looked.status == PlanStatus::kOk) << looked.reason;
    ASSERT_EQ(looked.path.size(), not_looked.path.size());
    for (std::size_t n = 0; n < looked.path.size(); ++n)
      EXPECT_EQ(looked.path[n].position, not_looked.path[n].position);
    if (looked.status != PlanStatus::kOk) break;
    planner_->report({looked.memory, PathOutcome::kReached, ""});
    other->report({not_looked.memory, PathOutcome::kReached, ""});
    flyTo(looked.path.back(), world, i);
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
    request_.trail.push_back({x, at(x, 2.5)});
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
  seeTheBeginningOf(corridorToHall());
  request_.bounds.min.x() = 5.0;
  EXPECT_EQ(planner_->plan(request_).status, PlanStatus::kOutOfBounds);
  request_.bounds = {};
  request_.zones.push_back({"shaft", {{2.0, 1.0}, {4.0, 1.0}, {4.0, 4.0}, {2.0, 4.0}}});
  EXPECT_EQ(planner_->plan(request_).status, PlanStatus::kOutOfBounds);
}

TEST_P(EveryPlanner, ReportsThatTheBudgetSaysHome) {
  seeTheBeginningOf(corridorToHall());
  request_.remaining_s = 0.1;
  const PlanResult result = planner_->plan(request_);
  EXPECT_EQ(result.status, PlanStatus::kBudgetSaysHome) << result.reason;
}

TEST_P(EveryPlanner, StaysOutOfNoGoZonesAndInsideTheBounds) {
  seeTheBeginningOf(corridorToHall());
  request_.zones.push_back({"shaft", {{7.0, 3.2}, {9.0, 3.2}, {9.0, 4.0}, {7.0, 4.0}}});
  request_.bounds.max.y() = 12.0;
  expectFreePathFromPose(planner_->plan(request_));
}

TEST_P(EveryPlanner, FindsItsWayHomeFromTheEndOfItsPath) {
  seeTheBeginningOf(corridorToHall());
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
  test::GridWorld world({36, 40, 10}, 0.5);
  // The side room's opening is farther from the trail than any planner calls visited.
  world.carve({{1.0, 1.0, 1.0}, {17.0, 7.0, 4.0}});
  world.carve({{4.0, 7.0, 1.0}, {9.0, 19.0, 4.0}});  // a side room nobody has seen
  world.enterRock(*map_);
  map_->markFree({{1.01, 1.01, 1.01}, {16.99, 6.99, 3.99}});
  request_.map = map_->freeze();
  for (double x = request_.home.position.x(); x <= 15.0; x += 0.5)
    request_.trail.push_back({x, at(x, 2.5)});
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
  seeTheBeginningOf(corridorToHall());
  request_.home = at(22.0, 18.0);  // never seen
  EXPECT_EQ(planner_->planHome(request_).status, PlanStatus::kNoPath);
}

TEST_P(EveryPlanner, DoesNotProposeATargetForeverThatIsRefusedEachTime) {
  seeTheBeginningOf(corridorToHall());
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
  seeTheBeginningOf(corridorToHall());
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

INSTANTIATE_TEST_SUITE_P(AsShipped, EveryPlanner, ::testing::ValuesIn(everyShipped()),
                         [](const auto& tested) {
                           return tested.param.robot + "_" + tested.param.planner;
                         });

TEST(PlannerFactory, ListsTheKnownNamesForAnUnknownOne) {
  mission::RunConfig config = load({"aerial", "gbplanner"});
  try {
    static_cast<void>(makePlanner("gbplaner", config.tree, config.robot, config.map.resolution_m));
    FAIL() << "an unknown name was accepted";
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("gbplanner"), std::string::npos);
  }
}

TEST(PlannerFactory, RefusesARobotWithLegsForPlannersThatFly) {
  int refused = 0;
  for (const std::string& name : plannerNames()) {
    mission::RunConfig config = load({"walker", name});
    const auto make = [&] {
      static_cast<void>(makePlanner(name, config.tree, config.robot, config.map.resolution_m));
    };
    if (plansForLegs(name)) {
      EXPECT_NO_THROW(make()) << name;
    } else {
      EXPECT_THROW(make(), OutsideError) << name;
      ++refused;
    }
  }
  EXPECT_EQ(refused, 4);
}

}  // namespace
}  // namespace spelunk::planners
