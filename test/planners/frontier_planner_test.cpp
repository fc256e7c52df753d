#include "spelunk/planners/baselines/frontier_planner.h"

#include <gtest/gtest.h>

#include "support/frontier_world.h"

namespace spelunk::planners::baselines {
namespace {

using test::FrontierWorld;

/// A hall with a side room; the robot looks around in it.
FrontierWorld aHall() {
  test::GridWorld world({60, 30, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {29.0, 6.0, 4.0}});
  world.carve({{12.0, 6.0, 1.0}, {15.0, 14.0, 4.0}});
  FrontierWorld hall(std::move(world));
  hall.lookFrom({4.0, 3.0, 2.5});
  hall.lookFrom({8.0, 3.0, 2.5});
  hall.request.home = {{4.0, 3.0, 2.5}, 0.0};
  return hall;
}

FrontierPlanner make(const FrontierWorld& world, const FrontierPlannerParams& params) {
  return {params, Preference::kNearest, world.robot, FrontierWorld::kResolution_m};
}

TEST(FrontierRrtStar, FliesToAFrontierOnAWayThatIsNotLongerThanRrtConnects) {
  const FrontierWorld hall = aHall();
  FrontierPlannerParams star = FrontierPlannerParams::forRrtStar();
  FrontierPlannerParams connect = star;
  connect.way_method = "adaptive";
  const PlanResult by_star = make(hall, star).plan(hall.request);
  const PlanResult by_connect = make(hall, connect).plan(hall.request);
  ASSERT_EQ(by_star.status, PlanStatus::kOk) << by_star.reason;
  ASSERT_EQ(by_connect.status, PlanStatus::kOk) << by_connect.reason;
  EXPECT_LE(lengthOf(by_star.path), lengthOf(by_connect.path) * 1.02);
}

TEST(FrontierRrtStar, PassesByFrontiersFromWhichTooLittleIsSeen) {
  const FrontierWorld hall = aHall();
  FrontierPlannerParams params = FrontierPlannerParams::forRrtStar();
  params.gain_min_m3 = 0.0;
  ASSERT_EQ(make(hall, params).plan(hall.request).status, PlanStatus::kOk);
  params.gain_min_m3 = 1e4;
  const PlanResult result = make(hall, params).plan(hall.request);
  EXPECT_EQ(result.status, PlanStatus::kNothingToGain) << result.reason;
}

TEST(FrontierRrtStar, CutsALoopOfItsTrailOnTheWayHome) {
  const FrontierWorld hall = aHall();
  PlanRequest request = hall.request;
  double time_s = 0.0;
  for (const double y : {3.0, 4.0, 5.0}) request.trail.push_back({time_s++, {{4.0, y, 2.5}, 0.0}});
  for (const double y : {5.0, 4.0, 3.0}) request.trail.push_back({time_s++, {{9.0, y, 2.5}, 0.0}});
  request.pose.position = {9.0, 3.0, 2.5};
  const PlanResult home = make(hall, FrontierPlannerParams::forRrtStar()).planHome(request);
  ASSERT_EQ(home.status, PlanStatus::kOk) << home.reason;
  EXPECT_NEAR(lengthOf(home.path), 5.0, 0.1);
}

TEST(FrontierRrtStar, ComesHomeAlongItsTrail) {
  const FrontierWorld hall = aHall();
  PlanRequest request = hall.request;
  for (int k = 0; k <= 4; ++k) request.trail.push_back({1.0 * k, {{4.0 + k, 3.0, 2.5}, 0.0}});
  FrontierPlanner planner = make(hall, FrontierPlannerParams::forRrtStar());
  const PlanResult home = planner.planHome(request);
  ASSERT_EQ(home.status, PlanStatus::kOk) << home.reason;
  EXPECT_NEAR(lengthOf(home.path), 4.0, 0.1);
  EXPECT_EQ(home.path.back().position, request.home.position);
}

TEST(FrontierParams, RefuseAWayMethodThatNavigationDoesNotKnow) {
  FrontierPlannerParams params;
  EXPECT_TRUE(params.problems().empty());
  params.way_method = "teleport";
  ASSERT_EQ(params.problems().size(), 1U);
  EXPECT_NE(params.problems()[0].find("teleport"), std::string::npos);
}

TEST(FrontierParams, WaysHomeAreRrtConnectsWhereThoseToFrontiersAreRrtStars) {
  const FrontierPlannerParams params = FrontierPlannerParams::forRrtStar();
  EXPECT_EQ(params.navigation().method, "rrt_star");
  EXPECT_EQ(params.homeNavigation().method, "adaptive");
  EXPECT_GT(params.homeNavigation().iterations, params.navigation().iterations);
  EXPECT_EQ(FrontierPlannerParams().homeNavigation().iterations,
            FrontierPlannerParams().navigation().iterations);
}

TEST(FrontierParams, EveryFrontierIsATargetOfTheNearestOne) {
  EXPECT_EQ(FrontierPlannerParams::forNearest().gain_min_m3, 0.0);
  EXPECT_GT(FrontierPlannerParams().gain_min_m3, 0.0);
}

}  // namespace
}  // namespace spelunk::planners::baselines
