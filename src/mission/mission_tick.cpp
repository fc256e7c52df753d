#include <algorithm>
#include <cstdio>

#include "mission_impl.h"
#include "spelunk/common/message_text.h"

namespace spelunk::mission {
namespace {

constexpr double kRefreshPeriod_s = 0.5;  // of the way home: a robot gets a metre or two farther
constexpr double kInputRetry_s = 0.5;
constexpr double kLookAgain_s = 1.0;  // some scans more of the ground ahead
constexpr double kHomeRetry_s = 1.0;
/// Before an ignored path is sent again: people need some time to see why it is.
constexpr double kSendAgain_s = 2.0;
constexpr const char* kNoWayIsClear = "no known way home is clear any more";
constexpr const char* kIgnored =
    "the robot does not follow its path: is the controller connected to `path` or "
    "`command/trajectory`?";

}  // namespace

/// The order is part of the promise to come home; what comes first is relied upon by what follows.
std::optional<Command> Mission::Impl::tick(double now_s) {
  now = now_s;
  updatePose();       // all below asks where the robot is
  updateEndurance();  // what is left decides everything below
  updateWayHome();    // and what the way home takes of it; also at rest, for people to see
  if (!mission::isRunning(task)) return flight.takeCommand();
  // Each of the following steps may stop the robot; what is below it then sees it at rest.
  checkInputs();     // a robot that does not know where it is must not judge its path
  checkPath();       // a robot off its path is not where the checks of the path look
  checkArrival();    // a path at its end has nothing ahead to be checked
  checkAhead();      // stop before an obstacle: nothing may come between seeing and stopping ...
  checkGround();     // ... nor before bad ground, which asks the robot to back off
  backOff();         // before anything plans: plans from beside bad ground fail
  checkEndurance();  // after all stops: a stop changes the way home, and then home comes first
  checkCause();      // the same for what the robot turned home for and is gone
  stepTakeOff();     // before anything that needs room around the robot
  stepHome();        // before plans: a robot that is at home needs none
  stepLanding();     // at once when home is reached
  stepPoint();       // the same for a flight to a point
  askForPlan();      // last: a plan begins from what was decided above
  return flight.takeCommand();
}

/// Between two reports the robot moves on. Where they come seldom it flies so slowly that it cannot
/// get farther off its path between them than it may.
void Mission::Impl::updatePose() {
  if (!watch.knowsPose()) return;
  watch.show(flight.movedOn(watch.reported(), std::min(now, watch.knownUntil())));
  const double period_s = watch.odometryPeriod();
  if (period_s <= 0.0) return;
  const double limit_mps = params.deviation_max_m / period_s;
  flight.limitSpeed(limit_mps);
  if (limit_mps >= robot.speed_max_mps || !mission::isRunning(task)) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "odometry comes every %.2f s: the robot moves at %.2f m/s; for %.2g m/s send it "
                "%.2g times a second or more often",
                period_s, limit_mps, robot.speed_max_mps,
                robot.speed_max_mps / params.deviation_max_m);
  if (throttle.allows("slow odometry", now)) log(LogLevel::kWarn, text);
}

void Mission::Impl::updateEndurance() { endurance.update(now); }

void Mission::Impl::updateWayHome() {
  if (!way_home.isDue(now)) return checkPromise();  // endurance goes down between two looks
  way_home.refreshAt(now + kRefreshPeriod_s);
  if (task == Task::kHome && flight.active() && !flight.active()->blockedAt()) {
    way_home.followActive(now);
  } else if (watch.knowsPose() && !way_home.refresh(now)) {
    happens(Event::kWayHomeLost, kNoWayIsClear);
  }
  checkPromise();
}

/// Says so at once when the promise to come home cannot be kept, and when it can be again.
void Mission::Impl::checkPromise() {
  std::string problem;
  if (mission::isRunning(task) && task != Task::kLand && !way_home.isAtHome()) {
    const double needed_s = endurance.guard().pessimistic(way_home.travel_s());
    if (!way_home.isClear())
      problem = kNoWayIsClear;
    else if (needed_s > endurance.guard().remaining())
      problem = withNumber("the known way home takes %.0f s if all goes slowly", needed_s) +
                withNumber(", %.0f s are left", endurance.guard().remaining());
  }
  if (problem.empty() == way_home_problem.empty()) return;
  way_home_problem = problem;
  if (!problem.empty())
    return say(LogLevel::kWarn, "promise", "the way home is not sure: " + problem);
  say(LogLevel::kInfo, "promise kept", "a way home is sure again");
}

void Mission::Impl::checkInputs() {
  const std::string problem = notes.problem.empty() ? watch.problem(now) : notes.problem;
  inputs_ok = problem.empty();
  if (inputs_ok) return;
  if (flight.active()) {
    happens(Event::kInputsFailed, problem);
  } else {
    say(LogLevel::kWarn, "input", problem);
  }
  desk.askAt(now + kInputRetry_s);
}

void Mission::Impl::checkPath() {
  if (flight.isIgnored(watch.reported().pose, watch.pose(), now)) {
    say(LogLevel::kWarn, "ignored", kIgnored);
    happens(Event::kPathIgnored, withDoubt(kIgnored));
    resume_s = now + kSendAgain_s;
    return;
  }
  if (flight.isOverdue(watch.pose(), now)) {
    ++replans_deviation;
    return happens(Event::kLeftPath,
                   "the robot did not come to the end of its path: planning anew");
  }
  if (const auto gap_m = flight.gapOffPath(watch.pose(), now)) {
    ++replans_deviation;
    return happens(
        Event::kLeftPath,
        withNumber("the robot is %.2f m off its path: holding and planning anew", *gap_m));
  }
  const auto late_rest = flight.lateRest(watch.pose(), now);
  if (!late_rest) return;
  const std::string reason_before = reason;
  desk.drop();
  flight.drop();  // it is timed from where the robot is, not from where it should be
  fly(*late_rest);
  reason = reason_before;
}

void Mission::Impl::checkArrival() {
  if (!flight.hasArrived(watch.pose(), now)) return;
  if (!flight.goesHome()) desk.noteOutcome(planners::PathOutcome::kReached, "");
  flight.drop();
  desk.askBy(now);
}

void Mission::Impl::checkAhead() {
  const auto gap_m = flight.findObstacleAhead(now);
  if (!gap_m) return;
  ++replans_obstacle;
  happens(Event::kObstacleAhead,
          withDoubt(
              withNumber("new obstacle %.1f m ahead on the path: stopped, planning anew", *gap_m)));
}

void Mission::Impl::checkGround() {
  const auto finding = ground.look(way_home.trail(), now);
  if (!finding) return;
  if (finding->kind == GroundFinding::Kind::kUnseen) {
    happens(Event::kGroundUnseen, finding->why);
    return desk.askAt(now + kLookAgain_s);
  }
  happens(Event::kGroundBad, finding->why);
  way_home.noteZone(finding->zone);
  space.zones().mark(finding->zone);
}

void Mission::Impl::backOff() {
  if (!ground.isToBackOff() || flight.active() || !inputs_ok || !isAtRest()) return;
  const Path back = ground.takeWayBack(way_home.trail());
  if (!back.empty()) flight.goBack(back, watch.pose(), now);
}

void Mission::Impl::checkEndurance() {
  if (way_home.margin_s() < 0.0)
    happens(Event::kEnduranceLow, "home by endurance: the way home takes what is left");
}

/// A way home that was lost and is known again, not only by the way that is being flown.
void Mission::Impl::checkCause() {
  if (task != Task::kHome || turned_for != Event::kWayHomeLost || now < next_cause_check_s) return;
  next_cause_check_s = now + kRefreshPeriod_s;
  if (!inputs_ok || !way_home.refresh(now) || way_home.margin_s() <= 0.0) return;
  happens(Event::kWayHomeFound, "a way home is known again: going on");
}

void Mission::Impl::stepHome() {
  if (task != Task::kHome || flight.active() || !mayMove()) return;
  if (way_home.isAtHome())
    return happens(vertical.hasStand() ? Event::kOverStand : Event::kAtHome, end_reason);
  const double pause_s = shown == MissionState::kHold ? kHomeRetry_s : 0.0;
  if (isAtRest() && now >= flight.holdsSince() + pause_s) launchHome();
}

void Mission::Impl::stepTakeOff() {
  if (task != Task::kTakeOff || flight.active() || !mayMove() || !isAtRest()) return;
  if (const auto climb = vertical.findClimb()) return fly(*climb);
  // On the ground the robot's box has no room: home is above it.
  if (!space.isTrailClear({way_home.home()}, robot.box_m)) way_home.begin();
  happens(Event::kUp, "took off");
}

void Mission::Impl::stepLanding() {
  if (task != Task::kLand || flight.active() || !mayMove() || !isAtRest()) return;
  if (vertical.hasLanded()) return happens(Event::kDown, end_reason);
  if (const auto down = vertical.findLanding()) return fly(*down);
  happens(Event::kDown, end_reason + "; hovers: something lies where it took off");
}

void Mission::Impl::stepPoint() {
  if (task == Task::kPoint && !desk.isBusy() && mayMove()) acceptStep(point.step(way_home, now));
}

void Mission::Impl::askForPlan() {
  if (!mayMove() || ground.isToBackOff()) return;
  if (desk.wantsPlan(task, way_home, now)) desk.ask(task, way_home, now);
}

}  // namespace spelunk::mission
