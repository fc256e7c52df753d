#include <algorithm>

#include "mission_impl.h"

namespace spelunk::mission {
namespace {

using Kind = RunningJob::Kind;
using planners::PlanStatus;

constexpr double kAskAfterEnd_s = 0.1;  // a tick: then the robot is at the end of its path

}  // namespace

void Mission::Impl::take(const PlanOutcome& outcome, double now_s) {
  now = std::max(now, now_s);
  const auto job = desk.finish(outcome, now);
  if (!job) return;
  switch (job->kind) {
    case Kind::kExplore:
      acceptExploration(*job, outcome);
      if (task == Task::kHome) desk.noteSecondLook(outcome.plan, now);  // this was one
      break;
    case Kind::kSecondLook:
      acceptSecondLook(*job, outcome);
      break;
    case Kind::kPlannersWayHome:
    case Kind::kNavigationsWayHome:
      acceptWayHome(*job, outcome.home);
      break;
    case Kind::kPoint:
      acceptStep(point.take(outcome.go_to, way_home, now));
      break;
  }
}

void Mission::Impl::askForPoint() {
  desk.askForPoint(way_home, now,
                   [&](const std::shared_ptr<const map::FrozenMap>& map, const Rng& rng) {
                     return point.job(map, rng);
                   });
}

void Mission::Impl::acceptExploration(const RunningJob& job, const PlanOutcome& outcome) {
  if (outcome.plan.status != PlanStatus::kOk) return noteNoPlan(job, outcome.plan);
  const Verdict verdict = judge(job, outcome, basis, way_home, now);
  if (!verdict.isAccepted()) return refuse(verdict, outcome.plan);
  flyProposal(verdict.path, verdict.rest, outcome);
}

/// `rest`: of the planner's path, beyond `path`; home from its end is known from there on.
void Mission::Impl::flyProposal(const Path& path, const Path& rest, const PlanOutcome& outcome) {
  fly(Leg(space.withHeadroom(path, SafeSpace::PathEnd::kMoves), outcome.plan.kind, robot.box_m));
  way_home.noteRoute(rest, outcome.home);
  desk.noteAccepted(outcome.plan, now);
  reason = outcome.plan.reason;
}

void Mission::Impl::acceptSecondLook(const RunningJob& job, const PlanOutcome& outcome) {
  desk.noteSecondLook(outcome.plan, now);
  const auto path = findAffordable(job, outcome, basis, way_home, now);
  if (!path) return;
  const std::string why = "affordable again on the way home: " + outcome.plan.reason;
  happens(Event::kAffordableAgain, why);
  flyProposal(*path, {}, outcome);
  reason = why;
}

void Mission::Impl::refuse(const Verdict& verdict, const planners::PlanResult& plan) {
  desk.noteRefused(plan, verdict.outcome, verdict.why);
  if (flight.active()) {
    desk.retryInFlight(now);
    reason = verdict.why;
    return;
  }
  if (verdict.outcome == planners::PathOutcome::kRejectedBudget && desk.noteUnaffordable())
    return happens(Event::kEnduranceLow, "home by endurance: no further path leaves a way home");
  noteFailure(verdict.why);
}

void Mission::Impl::noteNoPlan(const RunningJob& job, const planners::PlanResult& plan) {
  desk.noteNone(plan);
  if (!job.from_standstill) {
    desk.retryInFlight(now);
    if (flight.active()) desk.askBy(flight.active()->endTime() + kAskAfterEnd_s);
    return;
  }
  if (plan.status == PlanStatus::kNothingToGain)
    return happens(Event::kNothingLeft,
                   "explored: " + plan.reason + (notes.flaw.empty() ? "" : "; but " + notes.flaw));
  if (plan.status == PlanStatus::kBudgetSaysHome)
    return happens(Event::kEnduranceLow, "home by endurance: " + plan.reason);
  noteFailure(std::string(planners::toText(plan.status)) + ": " + plan.reason);
}

void Mission::Impl::noteFailure(const std::string& fault) {
  const std::string why = withDoubt(fault);
  if (desk.noteFailure(now)) return happens(Event::kNoPlanForLong, "no plan found: " + why);
  happens(Event::kNoPlan, "no plan (" + why + "): trying again");
}

void Mission::Impl::acceptWayHome(const RunningJob& job, const planners::PlanResult& home) {
  desk.closeWayHomeRequest();
  const bool is_late = flight.active() ? !job.isInTime(now)
                                       : distance(watch.pose(), job.pose) > WayHome::kBeginsHere_m;
  const bool is_found = home.status == PlanStatus::kOk && !is_late;
  if (job.kind == Kind::kNavigationsWayHome) {
    const auto leg = is_found && !flight.active() ? way_home.legOfFoundWay(home) : std::nullopt;
    if (!leg) return noteNoWayHome(job, home);
    fly(*leg);
    reason = home.reason;
    return;
  }
  if (!is_found || !space.isClear(home.path, robot.box_m)) return noteNoWayHome(job, home);
  const Path whole = flight.joined(home.path, job.takes_over_s, watch.pose(), now);
  if (const auto leg = way_home.legOfSeenWay(whole, now)) fly(*leg);
}

/// Planner and navigation are asked in turn until one of them knows a way, or the trail is free.
void Mission::Impl::noteNoWayHome(const RunningJob& job, const planners::PlanResult& home) {
  desk.noteNoWayHome(job, now);
  if (flight.active()) return;
  const bool was_searched = job.kind == Kind::kNavigationsWayHome;
  const std::string& obstacle = way_home.obstacle();  // empty where the trail was not tried yet
  say(LogLevel::kWarn, "home",
      (obstacle.empty() ? "no way home but the trail is known" : obstacle) +
          (was_searched ? "; no way round it is known: " : "; the planner knows no other: ") +
          home.reason);
}

void Mission::Impl::acceptStep(const PointStep& step) {
  switch (step.kind) {
    case PointStep::Kind::kNothing:
      return;
    case PointStep::Kind::kFly:
      return fly(step.leg);
    case PointStep::Kind::kStop:
      ++replans_obstacle;
      return happens(Event::kObstacleAhead, step.why);
    case PointStep::Kind::kAsk:
      return askForPoint();
    case PointStep::Kind::kReached:
      return happens(Event::kPointReached, step.why);
    case PointStep::Kind::kUnreachable:
      return happens(Event::kPointUnreachable, step.why);
  }
}

}  // namespace spelunk::mission
