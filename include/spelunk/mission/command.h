#pragma once

#include "spelunk/common/path.h"
#include "spelunk/common/posture.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// What the robot is to do now; replaces what it did before.
struct Command {
  Path path;              ///< Empty: stop and hold.
  Trajectory trajectory;  ///< The same path timed; empty with it.
  planners::PathKind kind = planners::PathKind::kLocal;
  Posture posture = Posture::kStand;  ///< kLie only with an empty path.
};

}  // namespace spelunk::mission
