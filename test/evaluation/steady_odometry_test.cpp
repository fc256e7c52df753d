#include <gtest/gtest.h>

#include <string>

#include "spelunk/common/log.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/planners/factory.h"
#include "support/meshes.h"
#include "support/short_sighted_setup.h"

namespace spelunk::evaluation {
namespace {

RunSetup roomSetup() {
  RunSetup setup = test::shortSightedSetup({{-7.3, 0.4, 1.7}, 0.1}, 90.0);
  setup.map.resolution_m = 0.15;
  return setup;
}

struct Flown {
  RunRecord record;
  std::size_t occupied_voxels = 0;
  int off_its_path = 0;
};

Flown fly(const RunSetup& setup) {
  setLogSink([](LogLevel, const std::string&) {});
  const sim::WorldMesh mesh = test::roomWithPillar();
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  MissionRun run(setup, mesh, *planner);
  Flown flown;
  flown.record = run.fly();
  flown.occupied_voxels = run.mission().map().freeze()->occupiedVoxels();
  flown.off_its_path = run.mission().status().replans_deviation;
  setLogSink({});
  return flown;
}

void expectExploredAndHome(const Flown& flown, const Flown& steady) {
  EXPECT_TRUE(flown.record.returned_home) << flown.record.outcome;
  EXPECT_EQ(flown.record.collisions, 0);
  EXPECT_NE(flown.record.outcome.find("explored"), std::string::npos) << flown.record.outcome;
  EXPECT_GT(flown.record.explored_volume_m3, 0.95 * steady.record.explored_volume_m3);
}

TEST(SteadyOdometry, MissionGoesOnThroughALoopClosure) {
  const Flown steady = fly(roomSetup());
  RunSetup setup = roomSetup();
  setup.sim.odometry_jumps_s = {8.0, 0.0, 0.0};
  setup.sim.odometry_jump_m = {0.9, 0.6, 0.1};
  setup.sim.odometry_jump_deg = 3.0;
  const Flown flown = fly(setup);
  expectExploredAndHome(flown, steady);
  // No second copy of the walls.
  EXPECT_LT(static_cast<double>(flown.occupied_voxels),
            1.15 * static_cast<double>(steady.occupied_voxels));
}

TEST(SteadyOdometry, MissionGoesOnThroughThreeSmallLoopClosures) {
  const Flown steady = fly(roomSetup());
  RunSetup setup = roomSetup();
  setup.sim.odometry_jumps_s = {6.0, 10.0, 14.0};
  setup.sim.odometry_jump_m = {0.75, 0.5, 0.05};
  setup.sim.odometry_jump_deg = 1.5;
  const Flown flown = fly(setup);
  expectExploredAndHome(flown, steady);
  EXPECT_LT(static_cast<double>(flown.occupied_voxels),
            1.2 * static_cast<double>(steady.occupied_voxels));
}

TEST(SteadyOdometry, OdometryTwiceASecondIsEnough) {
  const Flown steady = fly(roomSetup());
  RunSetup setup = roomSetup();
  setup.delays.odometry_period_s = 0.5;
  setup.time_limit_s = 150.0;
  const Flown flown = fly(setup);
  expectExploredAndHome(flown, steady);
  EXPECT_LE(flown.off_its_path, 1);
}

TEST(SteadyOdometry, SlowOdometryMakesTheRobotSlow) {
  const Flown steady = fly(roomSetup());
  RunSetup setup = roomSetup();
  setup.delays.odometry_period_s = 1.25;
  setup.time_limit_s = 300.0;
  const Flown flown = fly(setup);
  expectExploredAndHome(flown, steady);
  EXPECT_LE(flown.off_its_path, 1);
  EXPECT_GT(flown.record.mission_time_s, 1.3 * steady.record.mission_time_s);
}

}  // namespace
}  // namespace spelunk::evaluation
