#pragma once

#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/local_frame.h"
#include "spelunk/common/path.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// What is kept of a mission beside its map.
struct MissionRecord {
  AxisAlignedBox bounds;
  std::vector<NoGoZone> given_zones;   ///< By people.
  std::vector<NoGoZone> marked_zones;  ///< By the robot: its own trail may lead through them.
  Path trail;                          ///< First pose: home. Of the centre of the robot's box.
  double remaining_s = 0.0;            ///< Endurance when it was saved.
  planners::PlannerGraph graph;
  LocalFrame frame;  ///< In which all this is, and the map beside it. The file is in the caller's.
};

/// Writes `folder`/mission.json through a temporary file; makes the folder. Throws OutsideError
/// with path and reason.
void writeRecord(const std::string& folder, const MissionRecord& record);

/// Reads what writeRecord() wrote. Throws OutsideError if it is missing or not such a file.
[[nodiscard]] MissionRecord readRecord(const std::string& folder);

}  // namespace spelunk::mission
