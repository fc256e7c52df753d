#include <cstdio>

#include "mission_impl.h"
#include "spelunk/mission/openings_left.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;

GoToOutcome pointOutcome(Event event) {
  if (event == Event::kPointReached) return GoToOutcome::kReached;
  return event == Event::kPointUnreachable ? GoToOutcome::kUnreachable : GoToOutcome::kAborted;
}

}  // namespace

void Mission::Impl::happens(Event event, const std::string& why) {
  const Rule rule = ruleFor(task, event);
  if (rule.action == Action::kIgnore) return;
  const Task before = task;
  task = rule.next;
  if (task != before) resetForNewTask(event, why);
  switch (rule.action) {
    case Action::kIgnore:
    case Action::kGoOn:
      return;
    case Action::kExplore:
      end_reason.clear();
      standUp();
      desk.beginExploring(now);
      return show(MissionState::kExplore, why);
    case Action::kClimb:
      if (before != Task::kTakeOff) vertical.begin();
      return show(MissionState::kTakeOff, why);
    case Action::kDescend:
      return show(MissionState::kLand, why);
    case Action::kHold:
      return hold(event, why);
    case Action::kBackOff:
      hold(event, why);
      return ground.askToBackOff();
    case Action::kWait:
      flight.holdFrom(now);
      return show(MissionState::kHold, why);
    case Action::kTurnHome:
      return turnHome(event, before, why);
    case Action::kHalt:
      desk.drop();
      flight.stop(kindOf(robot) == RobotKind::kLegged ? Posture::kLie : Posture::kStand);
      return show(MissionState::kEStop, why);
    case Action::kFinish:
      flight.stop();
      return show(MissionState::kDone, why);
  }
}

void Mission::Impl::standUp() {
  if (flight.posture() == Posture::kStand) return;
  flight.stop();
  flight.holdFrom(now);
  resume_s = now + robot.stand_up_s;
}

/// The one place where a task ends: each part forgets what it was about to do for it. The motion
/// goes on until the new task says otherwise.
void Mission::Impl::resetForNewTask(Event event, const std::string& why) {
  desk.drop();
  ground.reset();
  point.end(pointOutcome(event), why, now);
}

void Mission::Impl::hold(Event event, const std::string& why) {
  const planners::PathOutcome outcome = outcomeOf(event);
  if (flight.active() && !flight.goesHome()) {
    desk.noteOutcome(outcome, why);
    point.noteHeld(outcome);
  }
  if (flight.active() || shown != MissionState::kHold) flight.stop();
  flight.holdFrom(now);
  way_home.forgetRoute();
  way_home.refreshAt(now);
  desk.drop();
  if (task == Task::kHome) desk.wantWayHome();  // the trail leads there, but maybe not shortest
  show(MissionState::kHold, why);
}

void Mission::Impl::turnHome(Event event, Task before, const std::string& why) {
  // What was too far may come into reach on the way, and what could not be reached may be seen.
  const bool may_find_more =
      before == Task::kExplore && (event == Event::kEnduranceLow || event == Event::kNoPlanForLong);
  turned_for = event;
  desk.drop();
  desk.beginHome(may_find_more ? PlanDesk::SecondLooks::kAllowed : PlanDesk::SecondLooks::kNone,
                 now);
  const auto openings = map::findOpenings(*space.map().freeze(), robot.box_m);
  desk.noteOpenings(openings);
  end_reason = why + (event == Event::kNothingLeft ? countText(openings) : "");
  show(MissionState::kHome, end_reason);
  if (mayMove()) launchHome();
}

void Mission::Impl::launchHome() {
  if (!flight.active() && way_home.isAtHome()) return;
  if (const auto leg = way_home.findLeg(now)) return fly(*leg);
  desk.wantWayHome();
  if (shown == MissionState::kHold && desk.isBusy())
    return flight.holdFrom(now);  // an answer is under way: a new stop would throw it away
  happens(Event::kWayHomeBlocked, way_home.obstacle() + ": holding and looking for another");
}

/// Whether the whole safety box stays clear along a leg.
bool Mission::Impl::isFullBox(const Leg& leg) const {
  return (leg.box.array() >= robot.box_m.array()).all();
}

void Mission::Impl::fly(const Leg& wanted) {
  Leg leg = wanted;
  if (task != Task::kTakeOff && task != Task::kLand)
    leg.path = space.withHeadroom(leg.path, SafeSpace::PathEnd::kStays);
  flight.fly(leg, watch.pose(), now);
  way_home.refreshAt(now);
  desk.noteFlown();
  if (task == Task::kTakeOff) return show(MissionState::kTakeOff, "climbing");
  if (task == Task::kLand) return show(MissionState::kLand, "going down");
  switch (leg.kind) {
    case PathKind::kLocal:
      return show(MissionState::kExplore, "local path");
    case PathKind::kReposition:
      return show(MissionState::kReposition, "repositioning");
    case PathKind::kHome:
      return show(MissionState::kHome,
                  isFullBox(leg) ? "flying home" : "flying home through a narrow place, slowly");
  }
}

void Mission::Impl::say(LogLevel level, const std::string& key, const std::string& text) {
  reason = text;
  if (throttle.allows(key, now)) log(level, text);
}

void Mission::Impl::show(MissionState next, const std::string& why) {
  reason = why;
  if (shown == next) return;
  shown = next;
  char stamp[32];
  std::snprintf(stamp, sizeof stamp, "%.1f s: ", now);
  log(LogLevel::kInfo, stamp + std::string(toText(next)) + ": " + why);
}

}  // namespace spelunk::mission
