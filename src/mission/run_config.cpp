#include "spelunk/mission/run_config.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "run_rules.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/file_lookup.h"

namespace spelunk::mission {
namespace {

namespace fs = std::filesystem;

/// Stems of the YAML files in a folder, sorted.
std::string namesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string robotFile(const RunChoice& choice) {
  if (looksLikePath(choice.robot)) return existingFile("robot", choice.robot, choice.folders);
  const std::string folder = choice.share_dir + "/config/robots";
  const std::string path = folder + "/" + choice.robot + ".yaml";
  if (!fs::exists(path))
    throw OutsideError("unknown robot '" + choice.robot + "' (no " + path +
                       "); give the path of a file or one of: " + namesIn(folder));
  return path;
}

/// Which planner's parameters are where.
struct PlannerChoice {
  std::string name;
  std::string file;  ///< Of the user; empty if there is none.
};

PlannerChoice plannerChoice(const RunChoice& choice) {
  if (!looksLikePath(choice.planner)) return {choice.planner, ""};
  const std::string file = existingFile("planner", choice.planner, choice.folders);
  ParamTree content;
  content.addYamlFile(file);
  const std::vector<std::string> sections = content.sections();
  if (sections.size() != 1)
    throw OutsideError("planner file '" + file + "' holds " + std::to_string(sections.size()) +
                       " sections; it must hold one, which names the planner, such as "
                       "`gbplanner: {max_vertices: 400}`");
  return {sections.front(), file};
}

void addIfPresent(ParamTree& tree, const std::string& path) {
  if (fs::exists(path)) tree.addYamlFile(path);
}

/// The sections of a run. What is 0 or absent and follows from another value is written out.
void readFollowing(ParamTree& tree, RunConfig& config) {
  config.map.range_max_m = 0.0;
  tree.read("map", config.map);
  if (config.map.range_max_m <= 0.0) config.map.range_max_m = mapRangeFor(config);
  for (SensorModel& sensor : config.robot.sensor_models)
    sensor = resolved(sensor, config.map.range_max_m);
  tree.read("mission", config.mission);
  tree.read("navigation", config.navigation);
  config.terrain.elevation.base_height_m = 0.0;
  config.terrain.elevation.body_m = config.robot.box_m;
  config.terrain.footprint.footprint_length_m = config.robot.box_m.x();
  config.terrain.footprint.footprint_width_m = config.robot.box_m.y();
  tree.read("terrain", config.terrain);
  if (config.terrain.elevation.base_height_m <= 0.0)
    config.terrain.elevation.base_height_m = config.robot.ride_height_m;
}

}  // namespace

std::string shareDir() {
  std::vector<std::string> places;
  if (const char* given = std::getenv("SPELUNK_SHARE")) places.emplace_back(given);
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);  // <prefix>/lib/spelunk/x
  if (!failure)
    places.push_back((program.parent_path() / "../../share/spelunk").lexically_normal());
  places.emplace_back(SPELUNK_SOURCE_SHARE);
  places.emplace_back(SPELUNK_INSTALL_SHARE);
  std::string looked_at;
  for (const std::string& place : places) {
    if (fs::exists(place + "/config/robots")) return place;
    looked_at += "\n  - " + place;
  }
  throw OutsideError("no folder with config/robots found; set SPELUNK_SHARE. Looked at:" +
                     looked_at);
}

RunConfig loadRunConfig(const RunChoice& choice) {
  RunConfig config;
  const std::string dir = choice.share_dir + "/config";
  const std::string robot_file = robotFile(choice);
  const PlannerChoice planner = plannerChoice(choice);
  ParamTree own;
  own.addYamlFile(robot_file);
  const bool is_legged = own.textOf("robot.kind", "aerial") == "legged";
  for (const std::string& name :
       {std::string("map"), std::string("mission"), std::string("navigation"), std::string("sim"),
        std::string("terrain"), "planners/" + planner.name}) {
    addIfPresent(config.tree, dir + "/" + name + ".yaml");
    if (is_legged) addIfPresent(config.tree, dir + "/" + name + "_legged.yaml");
  }
  config.tree.addYamlFile(robot_file);  // its own sections win over those that all robots share
  if (!planner.file.empty()) config.tree.addYamlFile(planner.file);
  for (const std::string& assignment : choice.assignments)
    config.tree.setAssignment(assignment, choice.assignments_origin);
  std::vector<std::string> folders{fs::path(robot_file).parent_path().string()};
  folders.insert(folders.end(), choice.folders.begin(), choice.folders.end());
  config.robot = loadRobot(config.tree, fs::path(robot_file).stem().string(), dir, folders);
  readFollowing(config.tree, config);
  for (const std::string& problem : config.navigation.problems()) config.tree.addProblem(problem);
  for (const std::string& problem : config.terrain.problems()) config.tree.addProblem(problem);
  for (const std::string& problem : problemsBetween(config)) config.tree.addProblem(problem);
  config.planner = planner.name;
  return config;
}

}  // namespace spelunk::mission
