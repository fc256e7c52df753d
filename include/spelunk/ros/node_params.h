#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "spelunk/common/params.h"

namespace spelunk::bridge {

/// What planner_node itself needs (private parameters ~robot, ~planner, ...). Parameters of robot,
/// map, mission and planner come from the files in `share_dir`/config and from ~set.
struct PlannerNodeParams {
  std::string robot = "aerial";
  std::string planner = "gbplanner";
  int seed = 1;
  double time_limit_s = 900.0;
  bool auto_start = false;
  std::string share_dir;
  std::string launch_dir;
  std::string world_frame = "world";
  std::string base_frame = "base_link";
  std::string frame_prefix;
  double silence_s = 3.0;
  double tick_rate_hz = 10.0;
  double view_period_s = 1.0;
  double octomap_period_s = 2.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("robot", robot, Bounds{}, "a name from config/robots or the path of a file",
          Audience::kUser);
    field("planner", planner, Bounds{}, "how to explore, or the path of a planner's file",
          Audience::kUser);
    field("seed", seed, Bounds{0.0, 2e9}, "of the planner's random draws", Audience::kUser);
    field("time_limit_s", time_limit_s, Bounds{1.0, 1e6}, "the robot is home by then",
          Audience::kUser);
    field("auto_start", auto_start, Bounds{}, "start as soon as cloud and odometry arrive",
          Audience::kUser);
    field("share_dir", share_dir, Bounds{}, "where config/ and worlds/ lie; empty: the package");
    field("launch_dir", launch_dir, Bounds{},
          "relative paths are seen from here, else from the node's working folder");
    field("world_frame", world_frame, Bounds{}, "fixed frame of map and paths", Audience::kUser);
    field("base_frame", base_frame, Bounds{},
          "the robot's base, found by tf where odometry is of another frame of the robot");
    field("frame_prefix", frame_prefix, Bounds{},
          "of the robot's frames, e.g. robot_1: robot_1/base_link (tf_prefix)", Audience::kUser);
    field("silence_s", silence_s, Bounds{0.2, 1000.0},
          "warn if cloud or odometry stay away longer");
    field("tick_rate_hz", tick_rate_hz, Bounds{1.0, 100.0}, "of the mission");
    field("view_period_s", view_period_s, Bounds{0.05, 100.0}, "between map clouds and markers");
    field("octomap_period_s", octomap_period_s, Bounds{0.05, 1000.0}, "between octomaps");
  }
};

/// What sim_node itself needs.
struct SimNodeParams {
  std::string world = "long_wall";
  std::string robot = "aerial";
  std::string planner = "gbplanner";
  int seed = 1;
  double speed_factor = 1.0;
  std::vector<std::string> start;
  double world_scale = 0.0;
  std::string world_up;
  std::string share_dir;
  std::string launch_dir;
  std::string worlds_dir;
  std::string cache_dir;
  std::string world_frame = "world";
  std::string base_frame = "base_link";
  std::string frame_prefix;
  bool clock = true;
  double odometry_rate_hz = 50.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("world", world, Bounds{}, "a name of worlds/ or the path of a mesh", Audience::kUser);
    field("robot", robot, Bounds{}, "a name from config/robots or the path of a file",
          Audience::kUser);
    field("planner", planner, Bounds{}, "whose parameters ~set may hold; not used otherwise");
    field("seed", seed, Bounds{0.0, 2e9}, "of noise, drop-outs, dust", Audience::kUser);
    field("speed_factor", speed_factor, Bounds{0.01, 1000.0}, "simulated seconds a real second",
          Audience::kUser);
    field("start", start, Bounds{}, "x, y, z, yaw; empty: the world's own", Audience::kUser);
    field("world_scale", world_scale, Bounds{0.0, 1e6},
          "metres a unit of the mesh; 0: as its <name>.json says, else 1", Audience::kUser);
    field("world_up", world_up, Bounds{},
          "axis of the mesh that points up: x, y, z; empty: as its <name>.json says, else z",
          Audience::kUser);
    field("share_dir", share_dir, Bounds{}, "where config/ and worlds/ lie; empty: the package");
    field("launch_dir", launch_dir, Bounds{},
          "relative paths are seen from here, else from the node's working folder");
    field("worlds_dir", worlds_dir, Bounds{}, "where worlds lie; empty: share_dir/worlds");
    field("cache_dir", cache_dir, Bounds{}, "for generated meshes; empty: ~/.cache/spelunk");
    field("world_frame", world_frame, Bounds{}, "fixed frame");
    field("base_frame", base_frame, Bounds{}, "frame of the robot's body");
    field("frame_prefix", frame_prefix, Bounds{},
          "of the robot's frames, e.g. robot_1: robot_1/base_link (tf_prefix)", Audience::kUser);
    field("clock", clock, Bounds{},
          "publish /clock; false: follow the one that another simulator publishes",
          Audience::kUser);
    field("odometry_rate_hz", odometry_rate_hz, Bounds{5.0, 400.0}, "odometry, tf and /clock");
  }
};

}  // namespace spelunk::bridge
