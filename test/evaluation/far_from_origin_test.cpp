#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "spelunk/common/log.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/evaluation/run_report.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/planners/factory.h"
#include "support/meshes.h"
#include "support/short_sighted_setup.h"
#include "support/temporary_folder.h"

namespace spelunk::evaluation {
namespace {

using test::TemporaryFolder;

const Eigen::Vector3d kUtm(467000.0, 5420000.0, 300.0);
const Eigen::Vector3d kMineGrid(6000.0, 3000.0, 100.0);

/// A room with a pillar as OBJ and sidecar, moved by `by`, every number with three decimals.
std::string writeRoom(const TemporaryFolder& folder, const Eigen::Vector3d& by) {
  const sim::WorldMesh room = test::roomWithPillar();
  std::string text;
  char line[128];
  for (const Eigen::Vector3f& vertex : room.vertices) {
    const Eigen::Vector3d at = vertex.cast<double>() + by;
    std::snprintf(line, sizeof line, "v %.3f %.3f %.3f\n", at.x(), at.y(), at.z());
    text += line;
  }
  for (const Eigen::Vector3i& corner : room.triangles) {
    std::snprintf(line, sizeof line, "f %d %d %d\n", corner.x() + 1, corner.y() + 1,
                  corner.z() + 1);
    text += line;
  }
  std::snprintf(line, sizeof line, "{\"start\": [%.3f, %.3f, %.3f, 0.1]}", by.x() - 7.3,
                by.y() + 0.4, by.z() + 1.7);
  folder.write("room.json", line);
  return folder.write("room.obj", text);
}

map::MapParams mapParams() {
  map::MapParams params;
  params.resolution_m = 0.15;
  params.range_max_m = 8.0;
  return params;
}

RunSetup setupFor(const sim::WorldMesh& mesh) {
  RunSetup setup = test::shortSightedSetup(*mesh.start, 40.0);
  setup.map = mapParams();
  return setup;
}

/// Flies in the room at an offset and writes the report into `out`.
RunRecord fly(const Eigen::Vector3d& by, const std::string& out, std::vector<GoToLeg> legs = {}) {
  setLogSink([](LogLevel, const std::string&) {});
  const TemporaryFolder folder;
  sim::Surroundings around;
  around.reach_m = 100.0;
  around.range_m = map::keyRange(mapParams());
  const sim::WorldMesh mesh = sim::loadWorldMesh(writeRoom(folder, by), {}, around);
  RunSetup setup = setupFor(mesh);
  for (GoToLeg& leg : legs) leg.target = mesh.frame.written(Eigen::Vector3d(leg.target + by));
  setup.legs = legs;
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  MissionRun run(setup, mesh, *planner);
  RunRecord record = run.fly();
  requireWritable(out);
  writeReport(out, {"gbplanner", "room", "aerial", 3, 40.0, mesh.frame}, record);
  run.mission().map().save(out + "/map.bt", mesh.frame);
  return record;
}

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The rows of timeline.csv, the position moved back to the millimetre.
std::string movedBack(const std::string& timeline, const Eigen::Vector3d& by) {
  constexpr std::size_t kX = 3;
  std::istringstream lines(timeline);
  std::string result;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t k = 0; std::getline(cells, cell, ','); ++k) {
      char moved[32];
      if (k >= kX && k < kX + 3) {
        const auto axis = static_cast<Eigen::Index>(k - kX);
        std::snprintf(moved, sizeof moved, "%.3f", std::stod(cell) - by[axis] + 0.0);
        cell = std::string(moved) == "-0.000" ? "0.000" : moved;
      }
      result += (k == 0 ? "" : ",") + cell;
    }
    result += "\n";
  }
  return result;
}

TEST(FarFromOrigin, TheSameFlightAnywhereToTheMillimetre) {
  const TemporaryFolder out;
  const RunRecord here = fly(Eigen::Vector3d::Zero(), out.at("here"));
  ASSERT_GT(here.path_length_m, 10.0) << here.outcome;
  const std::string expected =
      movedBack(textOf(out.at("here/timeline.csv")), Eigen::Vector3d::Zero());
  ASSERT_GT(expected.size(), 500U);
  for (const Eigen::Vector3d& by : {kUtm, kMineGrid}) {
    const RunRecord there = fly(by, out.at("there"));
    EXPECT_EQ(there.outcome, here.outcome);
    EXPECT_EQ(movedBack(textOf(out.at("there/timeline.csv")), by), expected);
  }
}

TEST(FarFromOrigin, MapFileSaysWhereItsOriginLies) {
  const TemporaryFolder out;
  (void)fly(kUtm, out.at("there"));
  const std::string map = textOf(out.at("there/map.bt"));
  EXPECT_NE(map.find("# origin 467000 5420000 300 m"), std::string::npos) << map.substr(0, 200);
  const auto summary = nlohmann::json::parse(textOf(out.at("there/summary.json")));
  EXPECT_EQ(summary["map_origin_m"], nlohmann::json({467000.0, 5420000.0, 300.0}));
  map::OccupancyMap loaded(mapParams());
  loaded.load(out.at("there/map.bt"));
  EXPECT_GT(loaded.freeze()->occupiedVoxels(), 1000U);
}

TEST(FarFromOrigin, PointsAskedForAndSpokenOfAreTheCallers) {
  const TemporaryFolder out;
  GoToLeg into_the_pillar;
  into_the_pillar.target = {1.8, 0.0, 1.5};
  const RunRecord record = fly(kUtm, out.at("there"), {into_the_pillar});
  ASSERT_EQ(record.legs.size(), 1U);
  const auto leg = nlohmann::json::parse(textOf(out.at("there/summary.json")))["legs"][0];
  EXPECT_EQ(leg["target_m"], nlohmann::json({467001.8, 5420000.0, 301.5}));
  EXPECT_NE(leg["outcome"], "reached");
  if (leg.contains("nearest_reachable_m")) {
    EXPECT_NEAR(leg["nearest_reachable_m"][1].get<double>(), 5420000.0, 10.0);
  }
}

TEST(FarFromOrigin, StartInTheWallIsNamedInTheCallersFrame) {
  const TemporaryFolder folder;
  const sim::WorldMesh mesh = sim::loadWorldMesh(writeRoom(folder, kUtm));
  RunSetup setup = setupFor(mesh);
  setup.start.position.y() = 4.0;
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  try {
    MissionRun run(setup, mesh, *planner);
    FAIL();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("(466992.7, 5420004, 301.7)"), std::string::npos)
        << error.what();
  }
}

TEST(FarFromOrigin, RefusalToStartIsSaidInTheCallersFrame) {
  setLogSink([](LogLevel, const std::string&) {});
  const TemporaryFolder folder;
  const sim::WorldMesh mesh = sim::loadWorldMesh(writeRoom(folder, kUtm));
  RunSetup setup = setupFor(mesh);
  setup.sim.body_m = Eigen::Vector3d::Constant(0.1);  // no collision yet, but none of the margin
  setup.start.position.y() = 3.85;                    // 0.3 m from the wall
  ParamTree tree;
  const auto planner =
      planners::makePlanner("gbplanner", tree, setup.robot, setup.map.resolution_m);
  MissionRun run(setup, mesh, *planner);
  try {
    (void)run.fly();
    FAIL();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("around (466992.7, 5420003.9, 301.7)"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace spelunk::evaluation
