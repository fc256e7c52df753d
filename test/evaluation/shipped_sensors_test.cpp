// Every sensor that strangers may own flies once, as the files describe it.
#include <gtest/gtest.h>

#include "spelunk/common/log.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/planners/factory.h"
#include "spelunk/sim/simulator.h"
#include "support/meshes.h"

namespace spelunk::evaluation {
namespace {

struct Flown {
  std::string sensor;
  std::string mounting;  ///< A setting of it, or nothing.
};

class ShippedSensor : public testing::TestWithParam<Flown> {};

TEST_P(ShippedSensor, ExploresARoomAndComesHome) {
  setLogSink([](LogLevel, const std::string&) {});
  const std::string section = "sensor." + GetParam().sensor + ".";
  mission::RunChoice choice;
  choice.share_dir = SPELUNK_SOURCE_DIR;
  choice.assignments = {"robot.sensors=[" + GetParam().sensor + "]", "map.resolution_m=0.2",
                        "gbplanner.gain_threshold_m3=5", "gbplanner.frontier_gain_m3=5"};
  if (!GetParam().mounting.empty()) choice.assignments.push_back(section + GetParam().mounting);
  mission::RunConfig config = mission::loadRunConfig(choice);
  RunSetup setup;
  setup.robot = config.robot;
  setup.sim = sim::readSimParams(config.tree);
  setup.map = config.map;
  setup.mission = config.mission;
  setup.start = {{-1.0, 0.0, 1.2}, 0.0};
  setup.time_limit_s = 40.0;
  const auto planner =
      planners::makePlanner("gbplanner", config.tree, config.robot, config.map.resolution_m);
  config.tree.requireClean();
  const sim::WorldMesh mesh = test::boxRoom({6.0F, 4.5F, 2.5F});
  MissionRun run(setup, mesh, *planner);
  const RunRecord record = run.fly();
  EXPECT_TRUE(record.returned_home) << record.outcome;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_GT(record.explored_volume_m3, 30.0) << record.outcome;
}

INSTANTIATE_TEST_SUITE_P(Sensors, ShippedSensor,
                         testing::Values(Flown{"livox_mid360", ""},
                                         Flown{"livox_mid360", "mount_roll_deg=180"},
                                         Flown{"livox_mid360", "mount_pitch_deg=20"},
                                         Flown{"ouster_os0_64", ""}, Flown{"ouster_os1_64", ""},
                                         Flown{"velodyne_vlp16", ""}, Flown{"realsense_d435", ""}),
                         [](const auto& flown) {
                           const std::string& mounting = flown.param.mounting;
                           return flown.param.sensor +
                                  (mounting.empty() ? ""
                                                    : "_" + mounting.substr(0, mounting.find('=')));
                         });

}  // namespace
}  // namespace spelunk::evaluation
