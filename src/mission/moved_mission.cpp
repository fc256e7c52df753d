#include "spelunk/mission/moved_mission.h"

#include <utility>

#include "spelunk/common/moved.h"

namespace spelunk::mission {

using spelunk::moved;

Answer moved(Answer answer, const Shift& shift) {
  answer.reason = moved(answer.reason, shift);
  return answer;
}

Command moved(Command command, const Shift& shift) {
  command.path = moved(std::move(command.path), shift);
  command.trajectory = moved(std::move(command.trajectory), shift);
  return command;
}

GoToStatus moved(GoToStatus status, const Shift& shift) {
  status.reason = moved(status.reason, shift);
  status.target = moved(status.target, shift);
  if (status.nearest_reachable) status.nearest_reachable = moved(*status.nearest_reachable, shift);
  return status;
}

MissionStatus moved(MissionStatus status, const Shift& shift) {
  status.reason = moved(status.reason, shift);
  status.end_reason = moved(status.end_reason, shift);
  status.go_to = moved(std::move(status.go_to), shift);
  return status;
}

}  // namespace spelunk::mission
