#include "spelunk/ros/node_setup.h"

#include <ros/node_handle.h>

#include <cstdlib>
#include <optional>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/common/file_lookup.h"
#include "spelunk/common/log.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/planners/factory.h"
#include "spelunk/ros/frame_names.h"
#include "spelunk/ros/params.h"
#include "spelunk/sim/start_proposal.h"

namespace spelunk::bridge {
namespace {

/// The node's own parameters before anything else is read, to know which files to read. Problems
/// are reported when everything is read again.
template <class Params>
Params readNodeParams(const PrivateParams& given) {
  ParamTree tree;
  addTo(tree, given.own);
  Params params;
  tree.read("node", params);
  if (params.share_dir.empty()) params.share_dir = mission::shareDir();
  params.world_frame = frameName(params.world_frame);
  return params;
}

/// The configuration of a run with all that belongs to a node in its tree, read and checked.
/// Both nodes read every section, so that one set of overrides serves both.
template <class Params>
mission::RunConfig loadConfig(const PrivateParams& given, const Params& params,
                              CloudParams& cloud) {
  mission::RunChoice choice;
  choice.share_dir = params.share_dir;
  choice.robot = params.robot;
  choice.planner = params.planner;
  choice.assignments = given.assignments;
  choice.assignments_origin = "~set";
  choice.folders = {params.launch_dir, ""};
  mission::RunConfig config = mission::loadRunConfig(choice);
  addTo(config.tree, given.own);
  Params own;
  config.tree.read("node", own);
  config.tree.read("cloud", cloud);
  if (cloud.voxel_size_m > config.map.resolution_m)
    config.tree.addProblem(
        "cloud.voxel_size_m = " + toText(cloud.voxel_size_m) +
        " is coarser than map.resolution_m = " + toText(config.map.resolution_m) +
        ": walls would have holes; set it to at most that");
  for (const std::string& problem : cloud.problems()) config.tree.addProblem(problem);
  return config;
}

/// The start that a parameter gives, world frame.
std::optional<Pose> startIn(const SimNodeParams& params) {
  if (params.start.empty()) return std::nullopt;
  std::vector<double> numbers;
  for (const std::string& text : params.start) {
    char* end = nullptr;
    numbers.push_back(std::strtod(text.c_str(), &end));
    if (text.empty() || *end != '\0') numbers.clear();
  }
  if (params.start.size() != 4 || numbers.size() != 4)
    throw OutsideError("~start must be four numbers x, y, z, yaw");
  return Pose{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
}

}  // namespace

PlannerSetup loadPlannerSetup(const ::ros::NodeHandle& private_node) {
  const PrivateParams given = readPrivateParams(private_node);
  PlannerSetup setup;
  setup.node = readNodeParams<PlannerNodeParams>(given);
  mission::RunConfig config = loadConfig(given, setup.node, setup.cloud);
  (void)sim::readSimParams(config.tree);
  setup.planner =
      planners::makePlanner(config.planner, config.tree, config.robot, config.map.resolution_m);
  for (const SensorModel& sensor : config.robot.sensor_models)
    if (setup.node.silence_s * sensor.rate_hz <= 1.0)
      config.tree.addProblem("~silence_s = " + toText(setup.node.silence_s) +
                             " is no longer than the time between scans of sensor." + sensor.name +
                             ".rate_hz = " + toText(sensor.rate_hz) +
                             ": every gap would be a warning; raise it");
  config.tree.requireClean();
  setup.robot = config.robot;
  setup.mission = config.mission;
  setup.navigation = config.navigation;
  setup.map = config.map;
  setup.terrain = config.terrain;
  return setup;
}

SimSetup loadSimSetup(const ::ros::NodeHandle& private_node) {
  const PrivateParams given = readPrivateParams(private_node);
  SimSetup setup;
  setup.node = readNodeParams<SimNodeParams>(given);
  setup.node.base_frame = frameName(setup.node.base_frame);
  if (setup.node.worlds_dir.empty()) setup.node.worlds_dir = setup.node.share_dir + "/worlds";
  if (setup.node.cache_dir.empty()) setup.node.cache_dir = sim::defaultCacheDir();
  CloudParams cloud;
  mission::RunConfig config = loadConfig(given, setup.node, cloud);
  setup.sim = sim::readSimParams(config.tree, config.robot);
  (void)planners::makePlanner(config.planner, config.tree, config.robot, config.map.resolution_m);
  config.tree.requireClean();
  setup.robot = config.robot;
  if (const auto start = startIn(setup.node)) setup.around.start = start->position;
  setup.around.reach_m = reachOf(config.robot, config.robot.endurance_s);
  setup.around.range_m = map::keyRange(config.map);
  return setup;
}

SimWorld openWorld(const SimSetup& setup) {
  const SimNodeParams& params = setup.node;
  const std::string name = looksLikePath(params.world)
                               ? existingFile("mesh", params.world, {params.launch_dir, ""})
                               : params.world;
  SimWorld world;
  world.mesh = sim::openWorld(
      name, params.worlds_dir, params.cache_dir,
      sim::meshFrameOf(params.world_scale, params.world_up, {"world_scale:=", "world_up:="}),
      setup.around);
  world.start = sim::chooseStart(world.mesh, startIn(params), setup.robot.box_m, "start:=");
  if (world.mesh.exploration_bounds)
    log(LogLevel::kInfo,
        "the bounds beside the mesh limit exploration where planner_node is told "
        "them: call its service ~set_bounds");
  return world;
}

}  // namespace spelunk::bridge
