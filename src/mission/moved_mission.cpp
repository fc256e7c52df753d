#include "spelunk/mission/moved_mission.h"

#include <utility>

#include "spelunk/common/moved.h"

namespace spelunk::mission {

using spelunk::moved;

Answer moved(Answer answer, const Eigen::Vector3d& by) {
  answer.reason = moved(answer.reason, by);
  return answer;
}

Command moved(Command command, const Eigen::Vector3d& by) {
  command.path = moved(std::move(command.path), by);
  command.trajectory = moved(std::move(command.trajectory), by);
  return command;
}

GoToStatus moved(GoToStatus status, const Eigen::Vector3d& by) {
  status.reason = moved(status.reason, by);
  status.target = moved(status.target, by);
  if (status.nearest_reachable) status.nearest_reachable = moved(*status.nearest_reachable, by);
  return status;
}

MissionStatus moved(MissionStatus status, const Eigen::Vector3d& by) {
  status.reason = moved(status.reason, by);
  status.end_reason = moved(status.end_reason, by);
  status.go_to = moved(std::move(status.go_to), by);
  return status;
}

}  // namespace spelunk::mission
