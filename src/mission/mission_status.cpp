#include "spelunk/mission/mission_status.h"

namespace spelunk::mission {

const char* toText(MissionState state) {
  switch (state) {
    case MissionState::kIdle:
      return "Idle";
    case MissionState::kTakeOff:
      return "TakeOff";
    case MissionState::kLand:
      return "Land";
    case MissionState::kExplore:
      return "Explore";
    case MissionState::kReposition:
      return "Reposition";
    case MissionState::kHome:
      return "Home";
    case MissionState::kHold:
      return "Hold";
    case MissionState::kDone:
      return "Done";
    case MissionState::kEStop:
      return "EStop";
  }
  return "unknown";
}

const char* toText(GoToOutcome outcome) {
  switch (outcome) {
    case GoToOutcome::kNone:
      return "none";
    case GoToOutcome::kUnderway:
      return "underway";
    case GoToOutcome::kReached:
      return "reached";
    case GoToOutcome::kUnreachable:
      return "unreachable";
    case GoToOutcome::kAborted:
      return "aborted";
  }
  return "unknown";
}

}  // namespace spelunk::mission
