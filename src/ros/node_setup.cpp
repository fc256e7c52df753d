#include "spelunk/ros/node_setup.h"

#include <ros/node_handle.h>

#include <cstdlib>
#include <filesystem>

#include "spelunk/common/contract.h"
#include "spelunk/planners/factory.h"
#include "spelunk/ros/params.h"

namespace spelunk::bridge {
namespace {

namespace fs = std::filesystem;

/// Where config/ and worlds/ lie: the installed package, or the sources it was built from.
std::string shareDir() {
  for (const char* folder : {SPELUNK_SHARE_DIR, SPELUNK_SOURCE_DIR})
    if (fs::is_directory(fs::path(folder) / "config")) return folder;
  throw OutsideError("the folder 'config' of spelunk was not found: set ~config_dir");
}

std::string cacheDir() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const fs::path base = cache && *cache ? fs::path(cache)
                        : home && *home ? fs::path(home) / ".cache"
                                        : fs::temp_directory_path();
  return (base / "spelunk").string();
}

/// The files of a robot and planner, the private parameters of a node over them.
ParamTree loadTree(const ::ros::NodeHandle& private_node, const std::string& config_dir,
                   const std::string& robot) {
  ParamTree tree;
  tree.addYamlFile(config_dir + "/robots/" + robot + ".yaml");
  for (const char* name : {"map", "mission", "sim"}) {
    const std::string path = config_dir + "/" + name + ".yaml";
    if (fs::exists(path)) tree.addYamlFile(path);
  }
  for (const std::string& planner : planners::plannerNames()) {
    const std::string path = config_dir + "/planners/" + planner + ".yaml";
    if (fs::exists(path)) tree.addYamlFile(path);
  }
  addPrivateParams(private_node, tree);
  return tree;
}

/// What both nodes read, so that one set of overrides serves both and unknown names are found.
struct Shared {
  RobotModel robot;
  map::MapParams map;
  mission::MissionParams mission;
  sim::SimParams sim;
  CloudParams cloud;
  std::unique_ptr<planners::ExplorationPlanner> planner;
};

Shared readShared(ParamTree& tree, const std::string& robot, const std::string& planner,
                  const std::string& config_dir) {
  Shared shared;
  shared.robot = loadRobot(tree, robot, config_dir);
  tree.read("map", shared.map);
  tree.read("mission", shared.mission);
  tree.read("sim", shared.sim);
  tree.read("cloud", shared.cloud);
  for (const std::string& problem : shared.cloud.problems()) tree.addProblem(problem);
  for (const std::string& name : planners::plannerNames()) {
    auto made = planners::makePlanner(name, tree, shared.robot, shared.map.resolution_m);
    if (name == planner) shared.planner = std::move(made);
  }
  return shared;
}

/// The node's own parameters before anything else is read, to know which files to read.
template <class Params>
Params readNodeParams(const ::ros::NodeHandle& private_node) {
  ParamTree tree;
  addPrivateParams(private_node, tree);
  Params params;
  tree.read("node", params);
  if (params.config_dir.empty()) params.config_dir = shareDir() + "/config";
  return params;
}

Pose startOf(const SimNodeParams& params, const sim::WorldMesh& world) {
  if (params.start.empty()) {
    if (world.start) return *world.start;
    throw OutsideError("world '" + params.world + "' has no start: give ~start as [x, y, z, yaw]");
  }
  if (params.start.size() != 4) throw OutsideError("~start must be [x, y, z, yaw]");
  const auto number = [&](std::size_t i) { return std::strtod(params.start[i].c_str(), nullptr); };
  return {{number(0), number(1), number(2)}, number(3)};
}

}  // namespace

PlannerSetup loadPlannerSetup(const ::ros::NodeHandle& private_node) {
  PlannerSetup setup;
  setup.node = readNodeParams<PlannerNodeParams>(private_node);
  ParamTree tree = loadTree(private_node, setup.node.config_dir, setup.node.robot);
  PlannerNodeParams checked;
  tree.read("node", checked);
  Shared shared = readShared(tree, setup.node.robot, setup.node.planner, setup.node.config_dir);
  if (!shared.planner)  // Throws, naming the planners there are.
    shared.planner = planners::makePlanner(setup.node.planner, tree, shared.robot,
                                           shared.map.resolution_m);
  tree.requireClean();
  setup.cloud = shared.cloud;
  setup.robot = shared.robot;
  setup.mission = shared.mission;
  setup.map = shared.map;
  setup.planner = std::move(shared.planner);
  return setup;
}

SimSetup loadSimSetup(const ::ros::NodeHandle& private_node) {
  SimSetup setup;
  setup.node = readNodeParams<SimNodeParams>(private_node);
  if (setup.node.worlds_dir.empty()) setup.node.worlds_dir = shareDir() + "/worlds";
  if (setup.node.cache_dir.empty()) setup.node.cache_dir = cacheDir();
  ParamTree tree = loadTree(private_node, setup.node.config_dir, setup.node.robot);
  SimNodeParams checked;
  tree.read("node", checked);
  const Shared shared = readShared(tree, setup.node.robot, "", setup.node.config_dir);
  tree.requireClean();
  setup.robot = shared.robot;
  setup.sim = shared.sim;
  setup.world = sim::openWorld(setup.node.world, setup.node.worlds_dir, setup.node.cache_dir);
  setup.start = startOf(setup.node, setup.world);
  return setup;
}

}  // namespace spelunk::bridge
