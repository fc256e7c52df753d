#include "spelunk/mission/run_config.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "spelunk/common/contract.h"
#include "spelunk/planners/factory.h"
#include "support/temporary_folder.h"

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

/// A folder of a user's own, outside the package.
class OwnFiles : public testing::Test {
 protected:
  [[nodiscard]] RunChoice choiceOf(const std::string& robot) const {
    RunChoice choice = shipped();
    choice.robot = robot;
    return choice;
  }

  test::TemporaryFolder folder_;
};

TEST_F(OwnFiles, RobotIsReadFromAPathAndItsSensorsFromBesideIt) {
  folder_.write("mule.yaml",
                "robot: {speed_max_mps: 1.25, sensors: [lidar_16, feeler, ./eye.yaml]}\n");
  folder_.write("feeler.yaml", "sensor: {feeler: {range_max_m: 3}}\n");
  folder_.write("eye.yaml", "sensor: {eye: {range_max_m: 4}}\n");
  RunConfig config = loadRunConfig(choiceOf(folder_.at("mule.yaml")));
  EXPECT_EQ(config.robot.name, "mule");
  EXPECT_EQ(config.robot.speed_max_mps, 1.25);
  ASSERT_EQ(config.robot.sensor_models.size(), 3U);
  EXPECT_EQ(config.robot.sensor_models[0].rows, 16) << "the package's own";
  EXPECT_EQ(config.robot.sensor_models[1].name, "feeler");
  EXPECT_EQ(config.robot.sensor_models[1].range_max_m, 3.0);
  EXPECT_EQ(config.robot.sensor_models[2].name, "eye");
}

TEST_F(OwnFiles, RelativePathsAreSeenFromTheGivenFolders) {
  folder_.write("mule.yaml", "robot: {speed_max_mps: 1.25}\n");
  RunChoice choice = choiceOf("mule.yaml");
  choice.folders = {folder_.at("nowhere"), folder_.at("")};
  EXPECT_EQ(loadRunConfig(choice).robot.speed_max_mps, 1.25);
  choice.folders = {folder_.at("nowhere"), "/"};
  const std::string text = problemsOf(choice);
  EXPECT_NE(text.find(folder_.at("nowhere") + "/mule.yaml"), std::string::npos) << text;
  EXPECT_NE(text.find("\n  - /mule.yaml"), std::string::npos) << text;
}

TEST_F(OwnFiles, SensorThatIsNowhereIsNamedWithThePlacesLookedAt) {
  folder_.write("mule.yaml", "robot: {sensors: [feeler]}\n");
  const std::string text = problemsOf(choiceOf(folder_.at("mule.yaml")));
  EXPECT_NE(text.find("config/sensors/feeler.yaml"), std::string::npos) << text;
  EXPECT_NE(text.find(folder_.at("feeler.yaml")), std::string::npos) << text;
}

TEST_F(OwnFiles, TwoSensorsOfOneNameAreAProblem) {
  folder_.write("mule.yaml", "robot: {sensors: [lidar_16, ./lidar_16.yaml]}\n");
  folder_.write("lidar_16.yaml", "sensor: {lidar_16: {rows: 8}}\n");
  const std::string text = problemsOf(choiceOf(folder_.at("mule.yaml")));
  EXPECT_NE(text.find("two are called 'lidar_16'"), std::string::npos) << text;
}

TEST_F(OwnFiles, PlannerFileNamesThePlannerByItsSection) {
  folder_.write("patient.yaml", "nbvp: {max_vertices: 123}\n");
  RunChoice choice = shipped();
  choice.planner = folder_.at("patient.yaml");
  RunConfig config = loadRunConfig(choice);
  EXPECT_EQ(config.planner, "nbvp");
  EXPECT_EQ(config.tree.textOf("nbvp.max_vertices", ""), "123");
}

TEST_F(OwnFiles, PlannerFileWithoutOneSectionIsRefused) {
  folder_.write("mixed.yaml", "nbvp: {max_vertices: 123}\nmap: {resolution_m: 0.2}\n");
  RunChoice choice = shipped();
  choice.planner = folder_.at("mixed.yaml");
  const std::string text = problemsOf(choice);
  EXPECT_NE(text.find("holds 2 sections"), std::string::npos) << text;
}

TEST(RunConfig, AssignmentWithoutValueIsNamed) {
  RunChoice choice = shipped();
  choice.assignments = {"mission.reserve_s"};
  EXPECT_THROW(static_cast<void>(loadRunConfig(choice)), OutsideError);
}

}  // namespace
}  // namespace spelunk::mission
