#pragma once

#include "spelunk/common/moved.h"
#include "spelunk/mission/answer.h"
#include "spelunk/mission/command.h"
#include "spelunk/mission/mission_status.h"

namespace spelunk::mission {

/// What a mission says, in another frame: see spelunk::moved().
[[nodiscard]] Answer moved(Answer answer, const Shift& shift);
[[nodiscard]] Command moved(Command command, const Shift& shift);
[[nodiscard]] GoToStatus moved(GoToStatus status, const Shift& shift);
[[nodiscard]] MissionStatus moved(MissionStatus status, const Shift& shift);

}  // namespace spelunk::mission
