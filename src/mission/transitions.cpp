#include "spelunk/mission/transitions.h"

#include <algorithm>

namespace spelunk::mission {
namespace {

/// All values of an enumeration up to its last one.
template <class Enum>
std::vector<Enum> upTo(Enum last) {
  std::vector<Enum> values;
  for (int k = 0; k <= static_cast<int>(last); ++k) values.push_back(static_cast<Enum>(k));
  return values;
}

}  // namespace

const std::vector<Rule>& rules() {
  using T = Task;
  using E = Event;
  using A = Action;
  static const std::vector<Rule> kRules{
      // Not started, and the mission is over: a robot at rest that people send out. One that was
      // loaded away from home may be called home.
      {T::kIdle, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kIdle, E::kPointAsked, T::kPoint, A::kGoOn},
      {T::kIdle, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kIdle, E::kStopAsked, T::kStopped, A::kHalt},
      {T::kDone, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kDone, E::kPointAsked, T::kPoint, A::kGoOn},
      {T::kDone, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kDone, E::kStopAsked, T::kStopped, A::kHalt},

      // Taking off. A robot that is called home meanwhile comes down again.
      {T::kTakeOff, E::kStartAsked, T::kTakeOff, A::kClimb},
      {T::kTakeOff, E::kPauseAsked, T::kPaused, A::kHold},
      {T::kTakeOff, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kTakeOff, E::kStopAsked, T::kStopped, A::kHalt},
      {T::kTakeOff, E::kFell, T::kStopped, A::kHalt},
      {T::kTakeOff, E::kInputsFailed, T::kTakeOff, A::kHold},
      {T::kTakeOff, E::kLeftPath, T::kTakeOff, A::kHold},
      {T::kTakeOff, E::kPathIgnored, T::kTakeOff, A::kHold},
      {T::kTakeOff, E::kObstacleAhead, T::kTakeOff, A::kHold},
      {T::kTakeOff, E::kGroundUnseen, T::kTakeOff, A::kHold},
      {T::kTakeOff, E::kGroundBad, T::kTakeOff, A::kBackOff},
      {T::kTakeOff, E::kEnduranceLow, T::kHome, A::kTurnHome},
      {T::kTakeOff, E::kUp, T::kExplore, A::kExplore},

      // Exploring.
      {T::kExplore, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kExplore, E::kOnGround, T::kTakeOff, A::kClimb},
      {T::kExplore, E::kPauseAsked, T::kPaused, A::kHold},
      {T::kExplore, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kExplore, E::kStopAsked, T::kStopped, A::kHalt},
      {T::kExplore, E::kFell, T::kStopped, A::kHalt},
      {T::kExplore, E::kInputsFailed, T::kExplore, A::kHold},
      {T::kExplore, E::kLeftPath, T::kExplore, A::kHold},
      {T::kExplore, E::kPathIgnored, T::kExplore, A::kHold},
      {T::kExplore, E::kObstacleAhead, T::kExplore, A::kHold},
      {T::kExplore, E::kGroundUnseen, T::kExplore, A::kHold},
      {T::kExplore, E::kGroundBad, T::kExplore, A::kBackOff},
      {T::kExplore, E::kEnduranceLow, T::kHome, A::kTurnHome},
      {T::kExplore, E::kWayHomeLost, T::kHome, A::kTurnHome},
      {T::kExplore, E::kNoPlan, T::kExplore, A::kWait},
      {T::kExplore, E::kNoPlanForLong, T::kHome, A::kTurnHome},
      {T::kExplore, E::kNothingLeft, T::kHome, A::kTurnHome},

      // On the way to a point. Without a way home that is known the robot holds where it is.
      {T::kPoint, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kPoint, E::kPauseAsked, T::kPaused, A::kHold},
      {T::kPoint, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kPoint, E::kStopAsked, T::kStopped, A::kHalt},
      {T::kPoint, E::kFell, T::kStopped, A::kHalt},
      {T::kPoint, E::kInputsFailed, T::kPoint, A::kHold},
      {T::kPoint, E::kLeftPath, T::kPoint, A::kHold},
      {T::kPoint, E::kPathIgnored, T::kPoint, A::kHold},
      {T::kPoint, E::kObstacleAhead, T::kPoint, A::kHold},
      {T::kPoint, E::kGroundUnseen, T::kPoint, A::kHold},
      {T::kPoint, E::kGroundBad, T::kPoint, A::kBackOff},
      {T::kPoint, E::kEnduranceLow, T::kHome, A::kTurnHome},
      {T::kPoint, E::kPointReached, T::kPaused, A::kHold},
      {T::kPoint, E::kPointUnreachable, T::kPaused, A::kHold},

      // On the way home nothing but home matters. What came into reach may be explored again; all
      // may be when the reason for which the robot turned round is gone.
      {T::kHome, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kHome, E::kPauseAsked, T::kPaused, A::kHold},
      {T::kHome, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kHome, E::kStopAsked, T::kStopped, A::kHalt},
      {T::kHome, E::kFell, T::kStopped, A::kHalt},
      {T::kHome, E::kInputsFailed, T::kHome, A::kHold},
      {T::kHome, E::kLeftPath, T::kHome, A::kHold},
      {T::kHome, E::kPathIgnored, T::kHome, A::kHold},
      {T::kHome, E::kObstacleAhead, T::kHome, A::kHold},
      {T::kHome, E::kGroundUnseen, T::kHome, A::kHold},
      {T::kHome, E::kGroundBad, T::kHome, A::kBackOff},
      {T::kHome, E::kAffordableAgain, T::kExplore, A::kGoOn},
      {T::kHome, E::kWayHomeFound, T::kExplore, A::kExplore},
      {T::kHome, E::kWayHomeBlocked, T::kHome, A::kHold},
      {T::kHome, E::kAtHome, T::kDone, A::kFinish},
      {T::kHome, E::kOverStand, T::kLand, A::kDescend},

      // Landing. Low endurance is one reason more to go on.
      {T::kLand, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kLand, E::kPauseAsked, T::kPaused, A::kHold},
      {T::kLand, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kLand, E::kStopAsked, T::kStopped, A::kHalt},
      {T::kLand, E::kFell, T::kStopped, A::kHalt},
      {T::kLand, E::kInputsFailed, T::kLand, A::kHold},
      {T::kLand, E::kLeftPath, T::kLand, A::kHold},
      {T::kLand, E::kPathIgnored, T::kLand, A::kHold},
      {T::kLand, E::kObstacleAhead, T::kLand, A::kHold},
      {T::kLand, E::kGroundUnseen, T::kLand, A::kHold},
      {T::kLand, E::kGroundBad, T::kLand, A::kBackOff},
      {T::kLand, E::kDown, T::kDone, A::kFinish},

      // Holding until people say how to go on.
      {T::kPaused, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kPaused, E::kPointAsked, T::kPoint, A::kGoOn},
      {T::kPaused, E::kHomeAsked, T::kHome, A::kTurnHome},
      {T::kPaused, E::kStopAsked, T::kStopped, A::kHalt},

      // Stopped at once: something was wrong, so that only a start releases it.
      {T::kStopped, E::kStartAsked, T::kExplore, A::kExplore},
      {T::kStopped, E::kStopAsked, T::kStopped, A::kHalt},
  };
  return kRules;
}

Rule ruleFor(Task task, Event event) {
  const auto found = std::find_if(rules().begin(), rules().end(), [&](const Rule& rule) {
    return rule.from == task && rule.event == event;
  });
  return found != rules().end() ? *found : Rule{task, event, task, Action::kIgnore};
}

const std::vector<Task>& allTasks() {
  static const std::vector<Task> kTasks = upTo(Task::kStopped);
  return kTasks;
}

const std::vector<Event>& allEvents() {
  static const std::vector<Event> kEvents = upTo(Event::kPointUnreachable);
  return kEvents;
}

bool isRunning(Task task) {
  return task == Task::kTakeOff || task == Task::kLand || task == Task::kExplore ||
         task == Task::kPoint || task == Task::kHome;
}

planners::PathOutcome outcomeOf(Event event) {
  switch (event) {
    case Event::kPathIgnored:
      return planners::PathOutcome::kNone;  // nobody has flown it
    case Event::kPauseAsked:
      return planners::PathOutcome::kReplaced;
    case Event::kPointReached:
      return planners::PathOutcome::kReached;
    case Event::kInputsFailed:
    case Event::kLeftPath:
      return planners::PathOutcome::kDeviated;
    default:
      return planners::PathOutcome::kBlocked;
  }
}

}  // namespace spelunk::mission
