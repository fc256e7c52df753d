#include "spelunk/mission/run_config.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "spelunk/common/contract.h"
#include "spelunk/planners/factory.h"

namespace spelunk::mission {
namespace {

RunChoice shipped() {
  RunChoice choice;
  choice.share_dir = SPELUNK_SOURCE_DIR;
  return choice;
}

TEST(RunConfig, ReadsShippedFiles) {
  const RunConfig config = loadRunConfig(shipped());
  EXPECT_EQ(config.robot.speed_max_mps, 2.0);
  EXPECT_FALSE(config.robot.sensor_models.empty());
  EXPECT_EQ(config.map.resolution_m, 0.15);
  EXPECT_GT(config.mission.reserve_s, 0.0);
}

TEST(RunConfig, FewParametersNeedALook) {
  RunConfig config = loadRunConfig(shipped());
  auto lines = describe("robot", config.robot);
  const auto append = [&](const std::vector<ParamDescription>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  append(describe("map", config.map));
  append(describe("mission", config.mission));
  append(describe("navigation", config.navigation));
  append(planners::describePlanner("gbplanner", config.tree));
  const auto is_for_users = [](const ParamDescription& line) {
    return line.audience == Audience::kUser;
  };
  const auto count = std::count_if(lines.begin(), lines.end(), is_for_users);
  EXPECT_LE(count, 15);
  EXPECT_GE(count, 8);
}

TEST(RunConfig, AssignmentsWin) {
  RunChoice choice = shipped();
  choice.assignments = {"mission.reserve_s=77", "robot.speed_max_mps=1.5"};
  const RunConfig config = loadRunConfig(choice);
  EXPECT_EQ(config.mission.reserve_s, 77.0);
  EXPECT_EQ(config.robot.speed_max_mps, 1.5);
}

TEST(RunConfig, UnknownRobotListsKnownOnes) {
  RunChoice choice = shipped();
  choice.robot = "submarine";
  try {
    static_cast<void>(loadRunConfig(choice));
    FAIL();
  } catch (const OutsideError& error) {
    EXPECT_NE(std::string(error.what()).find("aerial"), std::string::npos);
  }
}

/// All problems of a choice in one text (sections that others read are among them).
std::string problemsOf(const RunChoice& choice) {
  try {
    loadRunConfig(choice).tree.requireClean();
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

TEST(RunConfig, SensorThatReportsMissesNeedsAMapOfShorterRange) {
  RunChoice choice = shipped();
  choice.robot = "inspector";
  EXPECT_NE(problemsOf(choice).find("reports_misses"), std::string::npos);
  choice.assignments = {"map.range_max_m=4"};
  EXPECT_EQ(problemsOf(choice).find("reports_misses"), std::string::npos);
  const RunConfig config = loadRunConfig(choice);
  EXPECT_EQ(config.robot.speed_max_mps, 0.25);
  EXPECT_TRUE(config.robot.sensor_models.at(0).reports_misses);
}

TEST(RunConfig, UnknownNavigationMethodIsAProblem) {
  RunChoice choice = shipped();
  choice.assignments = {"navigation.method=astar"};
  EXPECT_NE(problemsOf(choice).find("plain_short"), std::string::npos);
}

TEST(RunConfig, AssignmentWithoutValueIsNamed) {
  RunChoice choice = shipped();
  choice.assignments = {"mission.reserve_s"};
  EXPECT_THROW(static_cast<void>(loadRunConfig(choice)), OutsideError);
}

}  // namespace
}  // namespace spelunk::mission
