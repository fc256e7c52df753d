#include "spelunk/ros/urgent_requests.h"

#include <utility>

namespace spelunk::bridge {

void UrgentRequests::ask(Urgent what) {
  const std::lock_guard lock(mutex_);
  if (waiting_ != Urgent::kStop) waiting_ = what;
}

std::optional<Urgent> UrgentRequests::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(waiting_, std::nullopt);
}

bool UrgentRequests::holdsRobot() const {
  const std::lock_guard lock(mutex_);
  return waiting_ && *waiting_ != Urgent::kHome;
}

mission::Answer carryOut(Urgent what, MissionCore& core) {
  if (what == Urgent::kHome) return core.mission.home();
  core.wants_start = false;
  return what == Urgent::kStop ? core.mission.emergencyStop() : core.mission.pause();
}

mission::Answer waitingAnswer(Urgent what) {
  switch (what) {
    case Urgent::kStop:
      return {true, "stopped; the mission is told as soon as its running work is done"};
    case Urgent::kPause:
      return {true, "holding; the mission is told as soon as its running work is done"};
    case Urgent::kHome:
      break;
  }
  return {true, "going home as soon as the mission's running work is done"};
}

}  // namespace spelunk::bridge
