#pragma once

#include <memory>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/mission/mission.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/ros/cloud_filter.h"
#include "spelunk/ros/node_params.h"
#include "spelunk/sim/simulator.h"

namespace ros {
class NodeHandle;
}

namespace spelunk::bridge {

/// All that planner_node is built from.
struct PlannerSetup {
  PlannerNodeParams node;
  CloudParams cloud;
  RobotModel robot;
  mission::MissionParams mission;
  navigation::NavigationParams navigation;
  map::MapParams map;
  terrain::TerrainParams terrain;
  std::unique_ptr<planners::ExplorationPlanner> planner;
};

/// All that sim_node is built from, besides its world.
struct SimSetup {
  SimNodeParams node;
  RobotModel robot;
  sim::SimParams sim;
};

/// Where the robot is to be.
struct SimWorld {
  sim::WorldMesh mesh;
  Pose start;
};

/// Reads the files of the configuration folder and the private parameters over them. Throws
/// OutsideError with every problem at once: unreadable, out of range, unknown.
[[nodiscard]] PlannerSetup loadPlannerSetup(const ::ros::NodeHandle& private_node);
[[nodiscard]] SimSetup loadSimSetup(const ::ros::NodeHandle& private_node);

/// Opens the world that ~world names, and generates it first where that has not been done. Throws
/// OutsideError if it cannot be opened, or if neither it nor ~start says where to start.
[[nodiscard]] SimWorld openWorld(const SimSetup& setup);

}  // namespace spelunk::bridge
