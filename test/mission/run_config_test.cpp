#include "spelunk/mission/run_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

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
  append(planners::describePlanner("gbplanner", config.tree, config.robot));
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

/// The same with the planner's, without the sections that nobody reads here.
std::string relationProblemsOf(const RunChoice& choice) {
  RunConfig config = loadRunConfig(choice);
  static_cast<void>(
      planners::makePlanner(choice.planner, config.tree, config.robot, config.map.resolution_m));
  std::string kept;
  try {
    config.tree.requireClean();
  } catch (const OutsideError& error) {
    std::istringstream lines(error.what());
    std::string line;
    std::getline(lines, line);  // how many there are
    while (std::getline(lines, line))
      if (line.find("no such parameter") == std::string::npos) kept += line + "\n";
  }
  return kept;
}

TEST(RunConfig, SensorThatReportsMissesNeedsAMapOfShorterRange) {
  RunChoice choice = shipped();
  choice.robot = "inspector";
  EXPECT_EQ(problemsOf(choice).find("reports_misses"), std::string::npos);
  const RunConfig config = loadRunConfig(choice);
  EXPECT_EQ(config.robot.speed_max_mps, 0.25);
  const SensorModel& sphere = config.robot.sensor_models.at(0);
  EXPECT_TRUE(sphere.reports_misses);
  EXPECT_LT(config.map.range_max_m, sphere.range_max_m);
  EXPECT_GE(config.map.range_max_m, 4.0);
  choice.assignments = {"map.range_max_m=5"};
  EXPECT_NE(problemsOf(choice).find("reports_misses"), std::string::npos);
}

TEST(RunConfig, OneRangeIsEnough) {
  RunChoice choice = shipped();
  choice.assignments = {"sensor.lidar_16.range_max_m=10"};
  const RunConfig config = loadRunConfig(choice);
  EXPECT_EQ(config.robot.sensor_models.at(0).gain_range_m, 10.0);
  EXPECT_EQ(config.map.range_max_m, 10.0);
  choice.assignments = {"map.range_max_m=12"};
  EXPECT_EQ(loadRunConfig(choice).robot.sensor_models.at(0).gain_range_m, 12.0);
}

TEST(RunConfig, ShippedRobotsKeepTheirRanges) {
  for (const char* robot : {"aerial", "walker"}) {
    RunChoice choice = shipped();
    choice.robot = robot;
    const RunConfig config = loadRunConfig(choice);
    EXPECT_EQ(config.map.range_max_m, 50.0);
    EXPECT_EQ(config.robot.sensor_models.at(0).gain_range_m, 50.0);
    if (kindOf(config.robot) == RobotKind::kAerial) continue;
    EXPECT_EQ(config.robot.sensor_models.at(1).gain_range_m, 1.0);
    EXPECT_EQ(config.terrain.elevation.base_height_m, 0.5);
    EXPECT_EQ(config.terrain.elevation.body_m, Eigen::Vector3d(1.2, 0.85, 0.7));
  }
}

/// One contradiction: what is set, and what the refusal must say.
struct Contradiction {
  std::string robot;
  std::vector<std::string> assignments;
  std::vector<std::string> said;
};

class Contradicting : public testing::TestWithParam<Contradiction> {};

TEST_P(Contradicting, IsRefusedWithBothNamesAndNumbers) {
  RunChoice choice = shipped();
  choice.robot = GetParam().robot;
  EXPECT_EQ(relationProblemsOf(choice), "") << "the shipped values contradict nothing";
  choice.assignments = GetParam().assignments;
  const std::string problems = relationProblemsOf(choice);
  for (const std::string& part : GetParam().said)
    EXPECT_NE(problems.find(part), std::string::npos) << part << " is not in: " << problems;
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, Contradicting,
    testing::Values(
        Contradiction{"aerial",
                      {"sensor.lidar_16.range_max_m=10", "sensor.lidar_16.gain_range_m=50"},
                      {"gain_range_m = 50", "range_max_m = 10", "set gain_range_m to 0"}},
        Contradiction{"aerial",
                      {"map.range_max_m=10", "sensor.lidar_16.gain_range_m=50"},
                      {"gain_range_m = 50", "map.range_max_m = 10"}},
        Contradiction{"aerial", {"sensor.lidar_16.range_min_m=60"}, {"range_min_m = 60", "50"}},
        Contradiction{"aerial",
                      {"map.range_min_m=5", "sensor.lidar_16.range_max_m=4"},
                      {"map.range_min_m = 5", "range_max_m = 4"}},
        Contradiction{"aerial",
                      {"robot.speed_max_mps=15"},
                      {"robot.speed_max_mps = 15", "lidar_16", "at most 14"}},
        Contradiction{"aerial",
                      {"sensor.lidar_16.range_max_m=2"},
                      {"robot.speed_max_mps = 2", "sees 2 m", "at most 1."}},
        Contradiction{"aerial",
                      {"sensor.lidar_16.mapping_period_s=10", "sensor.lidar_16.range_max_m=20"},
                      {"robot.speed_max_mps = 2", "sees 20 m", "map scans more often"}},
        Contradiction{"aerial",
                      {"mission.reserve_s=1000"},
                      {"mission.reserve_s = 1000", "robot.endurance_s = 900"}},
        Contradiction{"aerial",
                      {"map.resolution_m=0.5"},
                      {"map.resolution_m = 0.5", "robot.box_m = [1.1, 1.1, 0.4]"}},
        Contradiction{"aerial",
                      {"mission.home_radius_m=0.1"},
                      {"mission.home_radius_m = 0.1", "map.resolution_m = 0.15"}},
        Contradiction{"aerial",
                      {"mission.deviation_max_m=0.05"},
                      {"mission.deviation_max_m = 0.05", "map.resolution_m = 0.15"}},
        Contradiction{"aerial",
                      {"mission.plan_ahead_s=3"},
                      {"mission.plan_ahead_s = 3", "mission.replan_period_s = 2"}},
        Contradiction{"aerial",
                      {"robot.acceleration_max_mps2=4"},
                      {"acceleration_max_mps2 = 4", "braking_deceleration_mps2 = 2.5"}},
        Contradiction{"walker",
                      {"terrain.slope_limit_deg=15"},
                      {"terrain.slope_limit_deg = 15", "robot.slope_max_deg = 22"}},
        Contradiction{"walker",
                      {"robot.step_max_m=0.4"},
                      {"terrain.step_limit_m = 0.25", "robot.step_max_m = 0.4"}},
        Contradiction{"walker",
                      {"terrain.base_height_m=0.8"},
                      {"terrain.base_height_m = 0.8", "robot.ride_height_m = 0.5"}},
        Contradiction{"walker",
                      {"terrain.footprint_width_m=1"},
                      {"terrain.footprint_width_m = 1", "robot.box_m"}},
        Contradiction{"walker",
                      {"robot.speed_max_mps=3"},
                      {"terrain.reach_m = 4", "robot.speed_max_mps = 3"}}));

TEST(RunConfig, PlannersDoNotLookBeyondTheSensors) {
  const auto problemsWith = [](const std::string& planner,
                               const std::vector<std::string>& assignments) {
    RunChoice choice = shipped();
    choice.planner = planner;
    choice.assignments = assignments;
    return relationProblemsOf(choice);
  };
  const std::string near = "sensor.lidar_16.range_max_m=3.5";
  for (const std::string planner : {"informed", "frontier_nearest", "frontier_rrt_star"}) {
    const std::string range = planner + ".range_m=";
    EXPECT_NE(problemsWith(planner, {near, range + "6"}).find("range_m = 6"), std::string::npos);
    EXPECT_EQ(problemsWith(planner, {near, range + "0"}), "") << planner;
  }
  EXPECT_NE(problemsWith("gbplanner", {"gbplanner.edge_length_max_m=0.3", "map.resolution_m=0.4",
                                       "gbplanner.edge_length_min_m=0.1"})
                .find("edge_length_max_m = 0.3"),
            std::string::npos);
  EXPECT_NE(problemsWith("gbplanner",
                         {"gbplanner.local_box_m=[50, 50, 2]", "robot.box_m=[1.1, 1.1, 2.5]"})
                .find("robot.box_m = [1.1, 1.1, 2.5]"),
            std::string::npos);
  EXPECT_NE(problemsWith("gbplanner", {near, "gbplanner.visited_radius_m=5"})
                .find("visited_radius_m = 5"),
            std::string::npos);
}

TEST(RunConfig, FollowingRangesOfPlannersAreShown) {
  RunConfig config = loadRunConfig(shipped());
  const auto valueOf = [&](const std::string& planner, const std::string& name) -> std::string {
    for (const auto& line : planners::describePlanner(planner, config.tree, config.robot))
      if (line.name == planner + "." + name) return line.value;
    return "none";
  };
  EXPECT_EQ(valueOf("informed", "range_m").substr(0, 4), "11.4");
  EXPECT_EQ(valueOf("frontier_nearest", "range_m"), "4");
}

TEST(RunConfig, EveryShippedSensorFitsARobot) {
  namespace fs = std::filesystem;
  int sensors = 0;
  for (const auto& file : fs::directory_iterator(shipped().share_dir + "/config/sensors")) {
    RunChoice choice = shipped();
    const std::string name = file.path().stem().string();
    choice.assignments = {"robot.sensors=[" + name + "]"};
    EXPECT_EQ(relationProblemsOf(choice), "") << name;
    const SensorModel sensor = loadRunConfig(choice).robot.sensor_models.at(0);
    EXPECT_LE(sensor.gain_range_m, sensor.range_max_m) << name;
    EXPECT_LT(sensor.fov_lower_deg, sensor.fov_upper_deg) << name;
    ++sensors;
  }
  EXPECT_GE(sensors, 10);
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
