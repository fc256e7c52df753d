#pragma once

#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/mission/mission.h"
#include "spelunk/terrain/terrain_map.h"

namespace spelunk::mission {

/// The folder that holds config/, worlds/ and scripts/: $SPELUNK_SHARE if set, else the one that
/// was installed with this program, else the source folder. Throws OutsideError that names all
/// places looked at.
[[nodiscard]] std::string shareDir();

/// Which configuration a run asks for.
struct RunChoice {
  std::string share_dir;                     ///< See shareDir().
  std::string robot = "aerial";              ///< config/robots/<robot>.yaml or the path of a file
  std::string planner = "gbplanner";         ///< Its name, or the path of a file with its section.
  std::vector<std::string> assignments;      ///< "name=value", from the command line; they win.
  std::string assignments_origin = "--set";  ///< Named in messages about them.
  std::vector<std::string> folders{""};      ///< Relative paths are seen from these; "": current.
};

/// The configuration of a whole run. Whoever reads further sections (sim, the planner) does so from
/// `tree` and calls tree.requireClean() last, which reports all problems in one message.
struct RunConfig {
  ParamTree tree;
  RobotModel robot;
  map::MapParams map;
  MissionParams mission;
  navigation::NavigationParams navigation;
  terrain::TerrainParams terrain;  ///< Used by robots with legs.
  std::string planner;             ///< The planner's name.
};

/// Reads robot, sensors, map and mission from the files of a choice. A robot's sensor files may lie
/// beside its own file; a planner's own file lies over the shipped one of the planner whose section
/// it holds. Values that follow from others (0, or left out) are written out; values that
/// contradict each other are problems of the tree, with both names, both numbers and the remedy.
/// Throws OutsideError if a file is missing or not YAML; an unknown robot lists the known ones.
[[nodiscard]] RunConfig loadRunConfig(const RunChoice& choice);

}  // namespace spelunk::mission
