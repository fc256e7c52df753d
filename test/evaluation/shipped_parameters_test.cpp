// What config/ ships is what the structs hold by themselves: a test with a struct's defaults tests
// what flies. Where a file must differ, the tables here say why.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "spelunk/common/contract.h"
#include "spelunk/mission/mission_params.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/planners/baselines/frontier_planner_params.h"
#include "spelunk/planners/baselines/nbvp_params.h"
#include "spelunk/planners/baselines/oracle_params.h"
#include "spelunk/planners/factory.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"
#include "spelunk/planners/informed/informed_params.h"
#include "spelunk/sim/simulator.h"

namespace spelunk {
namespace {

namespace fs = std::filesystem;
using Values = std::map<std::string, std::string>;

const std::string kConfig = std::string(SPELUNK_SOURCE_DIR) + "/config";

template <class Params>
Values valuesOf(const std::string& section, const Params& params) {
  Values values;
  for (const ParamDescription& line : describe(section, params)) values[line.name] = line.value;
  return values;
}

/// Reads a section of a file over a struct's defaults and adds those that it changes.
template <class Params>
void addChanged(ParamTree& tree, const std::string& section, const Params& defaults,
                Values& changed) {
  Params read = defaults;
  tree.read(section, read);
  const Values before = valuesOf(section, defaults);
  for (const auto& [name, value] : valuesOf(section, read))
    if (before.at(name) != value) changed[name] = before.at(name) + " -> " + value;
}

/// Every name of a file whose value is not its struct's default. Fails for a name of no struct.
Values changedBy(const std::string& file) {
  using planners::baselines::FrontierPlannerParams;
  ParamTree tree;
  tree.addYamlFile(kConfig + "/" + file);
  Values changed;
  addChanged(tree, "map", map::MapParams{}, changed);
  addChanged(tree, "mission", mission::MissionParams{}, changed);
  addChanged(tree, "navigation", navigation::NavigationParams{}, changed);
  addChanged(tree, "terrain", terrain::TerrainParams{}, changed);
  addChanged(tree, "sim", sim::SimParams{}, changed);
  addChanged(tree, "walker", sim::WalkerParams{}, changed);
  addChanged(tree, "robot", RobotModel{}, changed);
  addChanged(tree, "gbplanner", planners::gbplanner::GbPlannerParams{}, changed);
  addChanged(tree, "informed", planners::informed::InformedParams{}, changed);
  addChanged(tree, "nbvp", planners::baselines::NbvpParams{}, changed);
  addChanged(tree, "oracle", planners::baselines::OracleParams{}, changed);
  addChanged(tree, "frontier_nearest", FrontierPlannerParams::forNearest(), changed);
  addChanged(tree, "frontier_utility", FrontierPlannerParams{}, changed);
  addChanged(tree, "frontier_rrt_star", FrontierPlannerParams::forRrtStar(), changed);
  for (const auto& entry : fs::directory_iterator(kConfig + "/sensors"))
    addChanged(tree, "sensor." + entry.path().stem().string(), SensorModel{}, changed);
  EXPECT_NO_THROW(tree.requireClean()) << file;
  return changed;
}

/// Files that describe something else than the structs' defaults do, and why.
const std::map<std::string, std::string>& otherThings() {
  static const std::map<std::string, std::string> kOther{
      {"mission_legged.yaml", "robots with legs are slow and not timed as exactly"},
      {"planners/gbplanner_legged.yaml", "robots with legs are slow and see from near the ground"},
      {"planners/nbvp_legged.yaml", "robots with legs are slow and see from near the ground"},
      {"robots/inspector.yaml", "another robot than the default, aerial"},
      {"robots/walker.yaml", "another robot than the default, aerial"},
      {"sensors/depth_camera.yaml", "another sensor than the default, lidar_16"},
      {"sensors/depth_front.yaml", "another sensor than the default, lidar_16"},
      {"sensors/depth_rear.yaml", "another sensor than the default, lidar_16"},
      {"sensors/livox_mid360.yaml", "another sensor than the default, lidar_16"},
      {"sensors/ouster_os0_64.yaml", "another sensor than the default, lidar_16"},
      {"sensors/ouster_os1_64.yaml", "another sensor than the default, lidar_16"},
      {"sensors/realsense_d435.yaml", "another sensor than the default, lidar_16"},
      {"sensors/sphere.yaml", "another sensor than the default, lidar_16"},
      {"sensors/velodyne_vlp16.yaml", "another sensor than the default, lidar_16"},
  };
  return kOther;
}

/// Single names that differ in files that are else like the defaults, and why.
const std::map<std::string, std::string>& otherNames() {
  static const std::map<std::string, std::string> kOther{
      {"map.range_max_m", "0 follows from the sensors; a map alone has none and needs a number"},
      {"map.resolution_m", "hand-worked tests of the map count in voxels of 0.2 m"},
      {"terrain.footprint_length_m", "left out, it is that of the walker's box"},
      {"terrain.footprint_width_m", "left out, it is that of the walker's box"},
      {"sensor.lidar_16.fov_vertical_deg", "0, no field given, means the 30 degrees of the file"},
  };
  return kOther;
}

std::vector<std::string> shippedFiles() {
  std::vector<std::string> files;
  for (const char* folder : {"", "planners", "robots", "sensors"})
    for (const auto& entry : fs::directory_iterator(fs::path(kConfig) / folder))
      if (entry.path().extension() == ".yaml")
        files.push_back(fs::relative(entry.path(), kConfig).string());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(ShippedParameters, AreTheDefaultsOfTheirStructs) {
  std::set<std::string> seen_differing;
  for (const std::string& file : shippedFiles()) {
    const Values changed = changedBy(file);
    if (otherThings().count(file) > 0) continue;
    for (const auto& [name, change] : changed) {
      EXPECT_EQ(otherNames().count(name), 1U) << file << ": " << name << ": " << change;
      seen_differing.insert(name);
    }
  }
  for (const auto& [name, why] : otherNames())
    EXPECT_EQ(seen_differing.count(name), 1U) << name << " is as its struct has it: no " << why;
}

TEST(ShippedParameters, FilesOfOtherThingsExistAndDiffer) {
  const std::vector<std::string> files = shippedFiles();
  for (const auto& [file, why] : otherThings()) {
    ASSERT_TRUE(std::binary_search(files.begin(), files.end(), file)) << file;
    EXPECT_FALSE(changedBy(file).empty()) << file << " does not differ: " << why;
  }
}

mission::RunChoice choiceOf(const std::string& planner) {
  mission::RunChoice choice;
  choice.share_dir = SPELUNK_SOURCE_DIR;
  choice.planner = planner;
  return choice;
}

/// Values of all planners as the aerial robot flies them, by planner.
std::map<std::string, Values> flownByAerial() {
  std::map<std::string, Values> flown;
  for (const std::string& planner : planners::plannerNames()) {
    mission::RunConfig config = mission::loadRunConfig(choiceOf(planner));
    for (const auto& line : planners::describePlanner(planner, config.tree, config.robot))
      flown[planner][line.name.substr(line.name.find('.') + 1)] = line.value;
  }
  return flown;
}

struct Difference {
  std::string planner;
  std::string value;
};

/// Where planners differ in a parameter of one name, and why that is meant. Each planner that is
/// not named has the same value as the others that are not.
const std::map<std::string, std::pair<std::string, std::set<std::string>>>& meantDifferences() {
  static const std::map<std::string, std::pair<std::string, std::set<std::string>>> kMeant{
      {"candidates", {"ways by RRT* cost as much as many other ones", {"frontier_rrt_star"}}},
      {"closing_height_m",
       {"2 m where gains count cones, 1.4 m where they count voxels; a change alters flights",
        {"gbplanner", "nbvp"}}},
      {"distance_weight",
       {"each paper's own: gamma_D of Dang 2020 for sums over paths, lambda of Bircher 2016",
        {"nbvp"}}},
      {"eta_factor",
       {"no reason known: 1.0, 1.1 (informed, nbvp) and 1.2 were flown; a change alters flights",
        {"gbplanner", "frontier_nearest", "frontier_utility", "frontier_rrt_star"}}},
      {"gain_min_m3",
       {"gains of rays of different lengths; nearest frontier asks for none",
        {"informed", "frontier_nearest", "frontier_rrt_star", "nbvp"}}},
      {"iterations",
       {"RRT* uses all it gets; Informed Exploration asks for ways to many samples a plan",
        {"informed", "frontier_rrt_star"}}},
      {"range_m",
       {"Informed Exploration sees as far as its sensor is dense, RRT* as Dang 2020 compares with "
        "it",
        {"informed", "frontier_rrt_star"}}},
      {"sample_spacing_m", {"scaled to the range of Informed Exploration", {"informed"}}},
      {"shortcut_length_max_m",
       {"no reason known: 12 m and 8 m were flown; a change alters flights", {"informed"}}},
      {"tried_radius_m",
       {"no reason known: 3 m and 1.5 m were flown; a change alters flights", {"gbplanner"}}},
      {"visited_radius_m",
       {"derived from the robot: with a LiDAR, places near the trail have shown all they can",
        {"informed"}}},
      {"way_method", {"what frontier_rrt_star is named after", {"frontier_rrt_star"}}},
  };
  return kMeant;
}

TEST(ShippedParameters, OfOneNameAreTheSameInAllPlanners) {
  const auto flown = flownByAerial();
  std::map<std::string, std::vector<Difference>> by_name;
  for (const auto& [planner, values] : flown)
    for (const auto& [name, value] : values) by_name[name].push_back({planner, value});
  int compared = 0;
  for (const auto& [name, differences] : by_name) {
    const auto meant = meantDifferences().find(name);
    const std::set<std::string> apart =
        meant == meantDifferences().end() ? std::set<std::string>{} : meant->second.second;
    std::set<std::string> values;
    std::string text;
    for (const Difference& each : differences) {
      text += " " + each.planner + "=" + each.value;
      if (apart.count(each.planner) == 0) values.insert(each.value);
    }
    EXPECT_LE(values.size(), 1U) << name << ":" << text;
    if (differences.size() > 1) ++compared;
  }
  EXPECT_GE(compared, 8);
}

/// An entry of the table whose planner does not differ (any more) hides the next difference.
TEST(ShippedParameters, MeantDifferencesAreThere) {
  const auto flown = flownByAerial();
  for (const auto& [name, meant] : meantDifferences()) {
    std::map<std::string, std::set<std::string>> values;
    for (const auto& [planner, all] : flown)
      if (all.count(name) > 0)
        values[meant.second.count(planner) > 0 ? "apart" : "others"].insert(all.at(name));
    std::set<std::string> all = values["apart"];
    all.insert(values["others"].begin(), values["others"].end());
    EXPECT_GT(all.size(), 1U) << name << " does not differ: " << meant.first;
  }
}

}  // namespace
}  // namespace spelunk
