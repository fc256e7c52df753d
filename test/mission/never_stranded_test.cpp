#include <gtest/gtest.h>

#include "spelunk/planners/factory.h"
#include "support/scripted_flight.h"

namespace spelunk {
namespace {

/// The mission guards all planners alike; how they fill their paths differs.
int missionsOf(const std::string& planner) {
  if (planner == "gbplanner") return 200;
  return planner == "nbvp" || planner == "frontier_rrt_star" ? 20 : 40;
}

/// Planner parameters that keep a plan cheap; names a planner does not know are simply not read.
std::unique_ptr<planners::ExplorationPlanner> cheapPlanner(const std::string& name) {
  ParamTree tree;
  tree.set(name + ".max_vertices", "60", "test");
  tree.set(name + ".local_box_m", "[14, 14, 4]", "test");
  tree.set(name + ".iterations", "500", "test");
  tree.set(name + ".frontier_voxels_min", "4", "test");
  tree.set(name + ".give_up_vertices", "200", "test");
  if (name == "nbvp") tree.set(name + ".gain_min_m3", "5", "test");
  return planners::makePlanner(name, tree, test::smallRobot(), test::coarseMap().resolution_m);
}

class NeverStranded : public testing::TestWithParam<std::string> {};

/// The invariant of the mission: whatever the world and the budget, the robot is home before its
/// endurance is gone and has touched nothing.
TEST_P(NeverStranded, RobotIsHomeWithEnduranceLeftInEveryMission) {
  setLogSink([](LogLevel, const std::string&) {});
  Rng rng(2021);
  double flown_m = 0.0;
  const int missions = missionsOf(GetParam());
  for (int k = 0; k < missions; ++k) {
    const double budget_s = rng.uniform(15.0, 70.0);
    const auto planner = cheapPlanner(GetParam());
    mission::MissionParams params;
    params.max_samples = 400;
    params.reserve_s = 5.0;
    params.replan_period_s = 3.0;
    test::ScriptedFlight flight(test::randomMine(rng.fork("world/" + std::to_string(k))),
                                {{16.0, 16.0, 2.0}, 0.0}, *planner, params,
                                static_cast<std::uint64_t>(k));
    flight.setBudget(budget_s);
    ASSERT_TRUE(flight.start().accepted);
    const bool done = flight.flyToTheEnd(budget_s);
    const auto status = flight.mission().status();
    ASSERT_TRUE(done) << "mission " << k << ", budget " << budget_s << " s: " << status.reason;
    EXPECT_GT(status.remaining_s, 0.0) << "mission " << k;
    EXPECT_LE((flight.state().pose.position - Eigen::Vector3d(16.0, 16.0, 2.0)).norm(), 1.0);
    EXPECT_EQ(flight.collisions(), 0) << "mission " << k;
    flown_m += status.distance_m;
  }
  EXPECT_GT(flown_m, 5.0 * missions) << "the missions did not explore";
}

INSTANTIATE_TEST_SUITE_P(AllPlanners, NeverStranded, testing::ValuesIn(planners::plannerNames()));

}  // namespace
}  // namespace spelunk
