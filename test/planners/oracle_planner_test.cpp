#include "spelunk/planners/baselines/oracle_planner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "spelunk/common/contract.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/planners/factory.h"
#include "support/grid_world.h"
#include "support/temporary_folder.h"

namespace spelunk::planners::baselines {
namespace {

constexpr double kResolution = 0.25;

RobotModel smallFlyer() {
  RobotModel robot;
  robot.box_m = {0.8, 0.8, 0.4};
  return robot;
}

/// A corridor along x (24 x 5 x 5 m) that is known up to `known_to_m`.
class ATourAlongACorridor : public ::testing::Test {
 protected:
  ATourAlongACorridor() : planner_({}, tour(), smallFlyer()) {
    request_.home = request_.pose = {{3.0, 2.5, 2.5}, 0.3};
    request_.rng = Rng(5);
    know(12.0);
  }
  [[nodiscard]] static graph::Polyline tour() {
    graph::Polyline points;
    for (double x = 3.0; x < 22.0; x += 1.0) points.emplace_back(x, 2.5, 2.5);
    return points;
  }
  void know(double known_to_m) {
    map::MapParams params;
    params.resolution_m = kResolution;
    map::OccupancyMap map(params);
    map.markFree({{1.0, 1.0, 1.0}, {known_to_m, 4.0, 4.0}});
    request_.map = map.freeze();
  }
  void expectFree(const PlanResult& result) {
    ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
    EXPECT_EQ(result.path.front().position, request_.pose.position);
    EXPECT_EQ(result.path.front().yaw, request_.pose.yaw);
    map::ConfigurationSpace space(smallFlyer().box_m, request_.map);
    EXPECT_TRUE(
        navigation::checkPath(space, result.path, request_.zones, request_.bounds).isFree());
  }

  PlanRequest request_;
  OraclePlanner planner_;
};

TEST_F(ATourAlongACorridor, IsFollowedAsFarAsItIsKnown) {
  const PlanResult first = planner_.plan(request_);
  expectFree(first);
  EXPECT_GT(first.path.back().position.x(), 10.0);
  EXPECT_LT(first.path.back().position.x(), 12.0);
  request_.pose = first.path.back();
  know(24.0);
  const PlanResult second = planner_.plan(request_);
  expectFree(second);
  EXPECT_NEAR(second.path.back().position.x(), 21.0, 1e-9);
}

TEST_F(ATourAlongACorridor, GoesRoundWhatStandsOnIt) {
  map::MapParams params;
  params.resolution_m = kResolution;
  map::OccupancyMap map(params);
  map.markFree({{1.0, 0.0, 0.0}, {6.0, 5.0, 5.0}});  // from 6 to 7 m free only beside the tour
  map.markFree({{6.0, 0.0, 0.0}, {7.0, 2.0, 5.0}});
  map.markFree({{7.0, 0.0, 0.0}, {12.0, 5.0, 5.0}});
  request_.map = map.freeze();
  PlanResult result = planner_.plan(request_);
  for (int i = 0; i < 5 && result.path.back().position.x() < 8.0; ++i) {
    expectFree(result);
    request_.pose = result.path.back();
    planner_.report({result.memory, PathOutcome::kReached, ""});
    result = planner_.plan(request_);
  }
  expectFree(result);
  EXPECT_GT(result.path.back().position.x(), 8.0);
}

TEST_F(ATourAlongACorridor, EndsAndSaysSo) {
  know(24.0);
  for (double x = 3.0; x < 19.0; x += 1.0) {
    request_.pose.position.x() = x;
    const PlanResult result = planner_.plan(request_);
    EXPECT_EQ(result.status, PlanStatus::kOk) << "at " << x;
    planner_.report({result.memory, PathOutcome::kReached, ""});
  }
  request_.pose.position = tour().back();
  EXPECT_EQ(planner_.plan(request_).status, PlanStatus::kNothingToGain);
  request_.pose.position = tour().front();
  OraclePlanner another({}, tour(), smallFlyer());
  EXPECT_EQ(another.plan(request_).status, PlanStatus::kOk) << "the tour begins again";
}

TEST_F(ATourAlongACorridor, DoesNotLeaveOutADetourThatEndsWhereItBegan) {
  know(24.0);
  graph::Polyline there_and_back = tour();
  there_and_back.insert(there_and_back.end(), there_and_back.rbegin(), there_and_back.rend());
  there_and_back.erase(there_and_back.begin(), there_and_back.begin() + 8);  // from 11 m on
  OraclePlanner planner({}, there_and_back, smallFlyer());
  request_.pose.position = there_and_back.front();
  const PlanResult result = planner.plan(request_);
  expectFree(result);
  const auto farthest = std::max_element(
      result.path.begin(), result.path.end(),
      [](const auto& a, const auto& b) { return a.position.x() < b.position.x(); });
  EXPECT_GT(farthest->position.x(), 19.0);
  EXPECT_LT(result.path.back().position.x(), 15.0);
}

TEST_F(ATourAlongACorridor, HasNoPathWhereNothingAheadIsKnown) {
  know(4.0);
  request_.pose.position.x() = 3.0;
  const PlanResult result = planner_.plan(request_);
  EXPECT_EQ(result.status, PlanStatus::kNoPath);
  EXPECT_FALSE(result.reason.empty());
}

TEST_F(ATourAlongACorridor, LeadsHomeAlongTheTrail) {
  request_.pose.position.x() = 10.0;
  for (double x = 3.0; x <= 10.0; x += 1.0) request_.trail.push_back({x, {{x, 2.5, 2.5}, 0.0}});
  const PlanResult home = planner_.planHome(request_);
  expectFree(home);
  EXPECT_EQ(home.path.back().position, request_.home.position);
}

TEST(ReadTour, TakesPointsAndNamesWhatIsWrong) {
  const test::TemporaryFolder folder;
  const auto good = folder.write("good.csv", "x_m,y_m,z_m\n1,2,3\n4.5,-5,0.25\n");
  const graph::Polyline tour = readTour(good);
  ASSERT_EQ(tour.size(), 2U);
  EXPECT_EQ(tour[1], Eigen::Vector3d(4.5, -5.0, 0.25));
  const auto messageOf = [](const std::string& path) -> std::string {
    try {
      static_cast<void>(readTour(path));
    } catch (const OutsideError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(messageOf("").find("scripts/best_possible"), std::string::npos);
  EXPECT_NE(messageOf(folder.at("none.csv")).find("none.csv"), std::string::npos);
  for (const char* bad : {"1,2", "1,2,nan", "1,2,3,4", "1;2;3", "a,b,c", "1,2,3 m"})
    EXPECT_NE(messageOf(folder.write("bad.csv", std::string("x_m,y_m,z_m\n") + bad)).find("line 2"),
              std::string::npos)
        << bad;
  EXPECT_NE(messageOf(folder.write("one.csv", "x_m,y_m,z_m\n1,2,3\n")).find("two points"),
            std::string::npos);
}

TEST(Factory, MakesAnOracleOnlyWithATour) {
  ParamTree tree;
  EXPECT_THROW(static_cast<void>(makePlanner("oracle", tree, smallFlyer(), kResolution)),
               OutsideError);
}

}  // namespace
}  // namespace spelunk::planners::baselines
