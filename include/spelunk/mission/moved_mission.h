#pragma once

#include <Eigen/Core>

#include "spelunk/mission/answer.h"
#include "spelunk/mission/command.h"
#include "spelunk/mission/mission_status.h"

namespace spelunk::mission {

/// What a mission says, in a parallel frame: see spelunk::moved().
[[nodiscard]] Answer moved(Answer answer, const Eigen::Vector3d& by);
[[nodiscard]] Command moved(Command command, const Eigen::Vector3d& by);
[[nodiscard]] GoToStatus moved(GoToStatus status, const Eigen::Vector3d& by);
[[nodiscard]] MissionStatus moved(MissionStatus status, const Eigen::Vector3d& by);

}  // namespace spelunk::mission
