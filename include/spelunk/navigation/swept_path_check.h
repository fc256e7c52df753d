#pragma once

#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/map/configuration_space.h"

namespace spelunk::navigation {

/// Why a path may not be flown.
enum class PathFault { kNone, kOccupied, kUnknown, kOutOfBounds, kNoGo };

[[nodiscard]] const char* toText(PathFault fault);  ///< "free", "occupied", "unknown", ...

/// The first fault along a path.
struct PathCheck {
  PathFault fault = PathFault::kNone;
  double arc_m =
      0.0;           ///< Arc length up to which the path is known to be good; its length if all is.
  std::string zone;  ///< Name of the no-go zone for kNoGo.

  [[nodiscard]] bool isFree() const { return fault == PathFault::kNone; }
};

/// Checks the box of `space` (centred on the path) moved along the whole path: every voxel it
/// touches must be free there, every position inside `bounds`, and the box outside all zones. A
/// segment is one ConfigurationSpace::sweep from end to end, so the answer equals what a planner
/// gets that sweeps the same segment. A path of one pose is checked there; an empty one breaks the
/// contract.
[[nodiscard]] PathCheck checkPath(map::ConfigurationSpace& space, const Path& path,
                                  const std::vector<NoGoZone>& zones, const AxisAlignedBox& bounds);

}  // namespace spelunk::navigation
