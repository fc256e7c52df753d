#pragma once

#include <vector>

#include "spelunk/mission/mission_status.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// What the robot is about. Whether it moves or holds for it is told by the flight.
enum class Task {
  kIdle,     ///< Not started yet.
  kTakeOff,  ///< Climbs from the ground, to explore then.
  kExplore,  ///< Explores.
  kPoint,    ///< Flies to a point that was asked for.
  kHome,     ///< Comes home.
  kLand,     ///< Goes down to where it took off.
  kPaused,   ///< Holds until it is asked to go on.
  kDone,     ///< Is at home, the mission is over.
  kStopped   ///< Was stopped at once; only a start releases it.
};

/// What may happen to it.
enum class Event {
  // People ask for it.
  kStartAsked,
  kPauseAsked,
  kHomeAsked,
  kPointAsked,
  kStopAsked,
  // The robot and its sensors.
  kFell,
  kInputsFailed,
  kLeftPath,
  kPathIgnored,  ///< The robot does not move though it is sent off.
  kObstacleAhead,
  kGroundUnseen,
  kGroundBad,
  // Endurance and the way home.
  kEnduranceLow,
  kAffordableAgain,
  kWayHomeLost,     ///< No way home is known any more.
  kWayHomeFound,    ///< One is known again.
  kWayHomeBlocked,  ///< None of the known ways can be flown now.
  kAtHome,
  kOnGround,   ///< Stands where it cannot explore from, and there is room above.
  kUp,         ///< The climb is at its end.
  kOverStand,  ///< Is at home, above where it took off.
  kDown,       ///< Stands there, or cannot get there.
  // Plans.
  kNoPlan,         ///< None this time.
  kNoPlanForLong,  ///< None for several times in a row.
  kNothingLeft,    ///< The planner has nothing to propose.
  kPointReached,
  kPointUnreachable
};

/// What is done about it.
enum class Action {
  kIgnore,    ///< Nothing: it cannot happen there, or does not matter; people's wishes are refused.
  kExplore,   ///< Asks for a plan; what is flown goes on until there is one.
  kGoOn,      ///< The task was changed on the way, the path for it is being flown.
  kClimb,     ///< Takes off.
  kDescend,   ///< Lands.
  kHold,      ///< Stops, forgets the path and goes on with the task from a standstill.
  kBackOff,   ///< The same, and first goes back half a metre.
  kWait,      ///< Holds as it does and asks for another plan.
  kTurnHome,  ///< Flies home, from the motion it is in.
  kHalt,      ///< Stops at once.
  kFinish     ///< The mission is over.
};

struct Rule {
  Task from;
  Event event;
  Task next;
  Action action;
};

/// The rules of the mission: what is not among them is ignored.
[[nodiscard]] const std::vector<Rule>& rules();
/// The rule for an event; for one that is ignored the task stays.
[[nodiscard]] Rule ruleFor(Task task, Event event);

[[nodiscard]] const std::vector<Task>& allTasks();
[[nodiscard]] const std::vector<Event>& allEvents();

/// Whether the mission is running: the robot moves or will move by itself.
[[nodiscard]] bool isRunning(Task task);
/// What an event that ends a path makes of it.
[[nodiscard]] planners::PathOutcome outcomeOf(Event event);

}  // namespace spelunk::mission
