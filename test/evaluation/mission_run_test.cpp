#include "spelunk/evaluation/mission_run.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/evaluation/run_report.h"
#include "spelunk/planners/factory.h"
#include "support/meshes.h"
#include "support/short_sighted_setup.h"
#include "support/temporary_folder.h"

namespace spelunk::evaluation {
namespace {

RunSetup roomSetup() { return test::shortSightedSetup({{-10.0, 0.0, 1.5}, 0.0}, 60.0); }

RunRecord flyRoom(const RunSetup& setup) {
  setLogSink([](LogLevel, const std::string&) {});
  const sim::WorldMesh mesh = test::boxRoom({30.0F, 8.0F, 4.0F});
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  MissionRun run(setup, mesh, *planner);
  return run.fly();
}

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(MissionRun, SeesTheRoomAndComesHomeWithoutTouching) {
  const RunRecord record = flyRoom(roomSetup());
  EXPECT_TRUE(record.returned_home) << record.outcome;
  EXPECT_TRUE(record.ended_as_it_may);
  EXPECT_EQ(record.collisions, 0);
  EXPECT_GT(record.min_clearance_m, 0.1);
  EXPECT_GT(record.remaining_at_home_s, 0.0);
  EXPECT_GT(record.explored_volume_m3, 500.0);  // of 960 m3 of air and the walls
  EXPECT_GT(record.path_length_m, 20.0);
  EXPECT_FALSE(record.plans.empty());
}

TEST(MissionRun, StoppedInMidFlightItHasWhatItGathered) {
  setLogSink([](LogLevel, const std::string&) {});
  const RunSetup setup = roomSetup();
  const sim::WorldMesh mesh = test::boxRoom({30.0F, 8.0F, 4.0F});
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  MissionRun run(setup, mesh, *planner);
  const RunRecord record = run.fly([&](const Progress& progress) {
    if (progress.t_s >= 12.0) run.stop("stopped by hand");
  });
  EXPECT_NEAR(record.mission_time_s, 12.0, 0.2);
  EXPECT_FALSE(record.returned_home);
  EXPECT_FALSE(record.ended_as_it_may);
  EXPECT_EQ(record.outcome.rfind("stopped by hand, ", 0), 0U) << record.outcome;
  EXPECT_GE(record.timeline.size(), 10U);
  EXPECT_GT(record.explored_volume_m3, 50.0);
}

TEST(MissionRun, SameSeedWritesTheSameTimelineByteForByte) {
  const test::TemporaryFolder folder;
  std::vector<std::string> texts;
  for (const char* name : {"a", "b"}) {
    requireWritable(folder.at(name));
    writeReport(folder.at(name), {"gbplanner", "room", "aerial", 3, 60.0}, flyRoom(roomSetup()));
    texts.push_back(textOf(folder.at(name) + "/timeline.csv"));
  }
  EXPECT_GT(texts[0].size(), 200U);
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(RunReport, SummaryHasEveryPromisedKey) {
  const test::TemporaryFolder folder;
  RunRecord record;
  record.outcome = "explored \"all\"";
  record.map_update_ms = {1.0, 2.0, 3.0};
  writeReport(folder.at(""), {"gbplanner", "w", "aerial", 1, 900.0}, record);
  const auto json = nlohmann::json::parse(textOf(folder.at("summary.json")));
  for (const char* key :
       {"planner", "world", "robot", "seed", "outcome", "mission_time_s", "wall_time_s",
        "explored_volume_m3", "reachable_volume_m3", "path_length_m", "collisions",
        "min_clearance_m", "returned_home", "remaining_at_home_s", "falls", "plans", "plan_time_ms",
        "map_update_ms", "peak_memory_mb"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["map_update_ms"]["median"], 2.0);
  EXPECT_GT(json["peak_memory_mb"].get<double>(), 1.0);
  EXPECT_EQ(textOf(folder.at("timeline.csv")),
            "t_s,explored_m3,distance_m,x_m,y_m,z_m,yaw_rad,remaining_s,state\n");
}

GoToLeg legTo(const Eigen::Vector3d& target) {
  GoToLeg leg;
  leg.target = target;
  return leg;
}

TEST(MissionRun, FliesToEachPointInTurnAndEndsAsReached) {
  RunSetup setup = roomSetup();
  SensorModel& sensor = setup.robot.sensor_models[0];
  sensor.fov_vertical_deg = 176;  // all round
  sensor.rows = 88;
  sensor.reports_misses = true;  // what is free ahead is seen to be free
  setup.map.range_max_m = 7.5;   // beyond it a point is a miss
  setup.time_limit_s = 120.0;
  setup.legs = {legTo({8.0, 1.0, 1.5}), legTo({-10.0, 0.0, 1.5})};  // the first one is unseen yet
  const RunRecord record = flyRoom(setup);
  EXPECT_EQ(record.outcome, "reached");
  EXPECT_TRUE(record.ended_as_it_may);
  EXPECT_EQ(record.collisions, 0);
  ASSERT_EQ(record.legs.size(), 2U);
  for (const GoToRecord& leg : record.legs) {
    EXPECT_EQ(leg.status.outcome, mission::GoToOutcome::kReached) << leg.status.reason;
    EXPECT_LT(leg.final_distance_m, 0.3);
    EXPECT_GT(leg.path_length_m, 17.5);
    EXPECT_GT(leg.execution_s, leg.path_length_m / setup.robot.speed_max_mps);
    EXPECT_GT(leg.status.planning_s, 0.0);
  }
  const mission::GoToStatus& home = record.legs[1].status;
  EXPECT_EQ(home.replans_obstacle + home.replans_deviation + home.replans_unseen, 0);
  EXPECT_NEAR(record.legs[0].path_length_m + record.legs[1].path_length_m, record.path_length_m,
              1.0);
  const test::TemporaryFolder folder;
  writeReport(folder.at(""), ReportHeader{}, record);
  const auto json = nlohmann::json::parse(textOf(folder.at("summary.json")));
  ASSERT_EQ(json["legs"].size(), 2U);
  EXPECT_EQ(json["legs"][1]["outcome"], "reached");
  EXPECT_EQ(json["legs"][1]["replans"], 0);
}

TEST(MissionRun, PointInTheRockEndsAtOnceWithTheReason) {
  RunSetup setup = roomSetup();
  setup.legs = {legTo({-10.0, 3.95, 1.5}), legTo({8.0, 1.0, 1.5})};
  const RunRecord record = flyRoom(setup);
  EXPECT_FALSE(record.ended_as_it_may);
  EXPECT_EQ(record.outcome.find("unreachable: "), 0U) << record.outcome;
  EXPECT_NE(record.outcome.find("obstacle"), std::string::npos) << record.outcome;
  EXPECT_EQ(record.legs.size(), 1U);
  EXPECT_LT(record.mission_time_s, 2.0);
}

TEST(RunReport, SaysWhereTheMeshLeaks) {
  const test::TemporaryFolder folder;
  RunRecord record;
  record.explored_outside_m3 = 12.5;
  writeReport(folder.at(""), {}, record);
  EXPECT_EQ(nlohmann::json::parse(textOf(folder.at("summary.json")))["mesh_leaks"], false);
  record.reachable.leak = Leak{{1.5, -2.0, 3.25}, true};
  writeReport(folder.at(""), {}, record);
  const auto json = nlohmann::json::parse(textOf(folder.at("summary.json")));
  EXPECT_EQ(json["mesh_leaks"], true);
  EXPECT_EQ(json["leak_m"], nlohmann::json({1.5, -2.0, 3.25}));
  EXPECT_EQ(json["explored_outside_m3"], 12.5);
}

TEST(RunReport, FolderThatCannotBeWrittenIsNamed) {
  const test::TemporaryFolder folder;
  folder.write("file", "x");
  try {
    requireWritable(folder.at("file/out"));
    FAIL();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("file/out"), std::string::npos);
  }
}

TEST(RunReport, SpreadIsMedianNinetyFifthAndMaximum) {
  std::vector<double> values;
  for (int k = 100; k >= 0; --k) values.push_back(k);
  const Spread spread = spreadOf(values);
  EXPECT_EQ(spread.median, 50.0);
  EXPECT_EQ(spread.p95, 95.0);
  EXPECT_EQ(spread.max, 100.0);
  EXPECT_EQ(spreadOf({}).max, 0.0);
}

}  // namespace
}  // namespace spelunk::evaluation
