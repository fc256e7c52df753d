#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mission_impl.h"
#include "spelunk/navigation/rounded_curve.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr int kScansBeforePlan = 3;
constexpr int kFailuresBeforeHome = 5;
constexpr double kRetryPeriod_s = 0.5;
constexpr double kRetryInFlight_s = 1.0;
constexpr double kAskBeforeEnd_s = 0.5;  // on top of plan_ahead_s
constexpr double kLatencySlack = 1.3;
constexpr double kSpliceClearance_m = 1.0;
constexpr double kCutStep_m = 1.0;
constexpr double kLookPeriod_s = 10.0;     // between two looks on the way home
constexpr double kLookBeforeHome_s = 5.0;  // not with home right ahead
constexpr double kShortestCut_m = 2.0;     // less is not worth the way
constexpr double kStartGap_m = 0.5;
constexpr double kCornerTolerances_m[] = {0.6, 0.3};
constexpr double kLeastTolerance_m = 0.1;
constexpr double kTightTolerance_m = 0.02;  // without its margin the box has no room for more
constexpr double kLineTolerance_m = 0.02;

Path pathOf(const std::vector<Eigen::Vector3d>& points) {
  Path path;
  for (const Eigen::Vector3d& point : points) path.push_back({point, 0.0});
  return path;
}

}  // namespace

bool Mission::Impl::wantsPlanInFlight() const {
  const double left_s = active->endTime() - now;
  if (active->blockedAt()) return true;
  if (left_s <= params.plan_ahead_s + kAskBeforeEnd_s) return true;
  return active->kind() == planners::PathKind::kLocal &&
         now - last_accept_s >= params.replan_period_s;
}

bool Mission::Impl::wantsPlan() const {
  if (goal == Goal::kGoTo) return false;
  if (!inputs_ok || pending || running || backs_off || now < next_ask_s) return false;
  if (goal == Goal::kHome) return wants_way_home ? active || isAtRest() : wantsSecondLook();
  if (active) return wantsPlanInFlight();
  return scans >= kScansBeforePlan && isAtRest();
}

/// The way home is flown in less time than was feared, and leads past other places.
bool Mission::Impl::wantsSecondLook() const {
  return may_look_again && active && !active->blockedAt() && now >= next_look_s &&
         now >= last_accept_s + kLookPeriod_s && guard.margin(way_home_s) > 0.0 &&
         active->endTime() - now > params.plan_ahead_s + kLookBeforeHome_s;
}

void Mission::Impl::askForPlan() {
  if (wantsPlan()) makeJob();
}

void Mission::Impl::makeJob() {
  frozen = map.freeze();
  home_graph->connect(frozen);
  const double voxel = frozen->resolution();
  status.known_volume_m3 = static_cast<double>(frozen->freeVoxels()) * voxel * voxel * voxel;
  RunningJob job;
  job.number = next_job++;
  job.is_second_look = goal == Goal::kHome && !wants_way_home;
  job.explore = goal == Goal::kExplore || job.is_second_look;
  job.from_standstill = !active;
  job.asked_s = now;
  job.takes_over_s = now;
  job.pose = input.latest()->pose;
  PlanJob plan;
  if (active) {
    const double ahead = std::max(params.plan_ahead_s, kLatencySlack * latency_s);
    job.takes_over_s = std::min(now + ahead, std::max(now, active->endTime()));
    const TrajectoryPoint then = active->reference(job.takes_over_s);
    job.pose = then.pose;
    plan.request.velocity = then.velocity;
    const bool too_near = active->blockedAt() && active->arcAt(job.takes_over_s) >
                                                     *active->blockedAt() - kSpliceClearance_m;
    if (too_near) return;
  }
  plan.number = job.number;
  plan.explore = job.explore;
  planners::PlanRequest& request = plan.request;
  request.map = frozen;
  request.time_s = job.takes_over_s;
  request.pose = job.pose;
  request.home = home_graph->home();
  request.remaining_s = guard.disposable(job.takes_over_s - now);
  request.bounds = limits;
  request.zones = no_go;
  request.trail = stamped_trail;
  request.last_outcome = active ? planners::PathOutcome::kReplaced : last_outcome;
  request.last_reason = last_reason;
  request.budget.iterations = params.max_samples;
  request.rng = rng.fork("plan/" + std::to_string(job.number));
  job.by_navigation = goal == Goal::kHome && !active && asks_navigation;
  if (job.by_navigation) plan.way_home = searchForWayHome(job);
  pending = std::move(plan);
  running = job;
}

std::optional<Command> Mission::Impl::accept(const PlanOutcome& outcome, double now_s) {
  now = std::max(now, now_s);
  if (!running || running->number != outcome.number) return std::nullopt;
  const RunningJob job = *running;
  running.reset();
  pending.reset();
  latency_s = now - job.asked_s;
  if (job.explore) {
    ++status.plans;
    status.last_stats = outcome.plan.stats;
    status.last_plan_status = planners::toText(outcome.plan.status);
    remaining_targets = outcome.plan.remaining;
    if (goal == Goal::kExplore) acceptExploration(job, outcome);
    if (goal == Goal::kHome) acceptSecondLook(job, outcome);
  } else if (goal == Goal::kHome) {
    acceptWayHome(job, outcome.home);
  } else if (goal == Goal::kGoTo) {
    acceptGoTo(outcome.go_to);
  }
  return takeCommand();
}

Path Mission::Impl::joined(const RunningJob& job, const Path& path) const {
  if (!active) {
    Path whole = path;
    whole.front() = input.latest()->pose;
    return whole;
  }
  Path whole = active->line(active->arcAt(now), active->arcAt(job.takes_over_s));
  whole.insert(whole.end(), path.begin() + (whole.size() > 1 ? 1 : 0), path.end());
  return whole;
}

navigation::PathCheck Mission::Impl::checkLeaving(const Path& path, const Eigen::Vector3d& box,
                                                  const std::vector<NoGoZone>& zones,
                                                  const AxisAlignedBox& bounds) {
  const auto check = navigation::checkPath(spaceOf(box), path, zones, bounds);
  constexpr double kStepOut_m = 0.7;
  if (check.isFree() || path.size() < 2 || distance(path[0], path[1]) > kStepOut_m) return check;
  const Path step_out(path.begin(), path.begin() + 2);
  if (!navigation::checkPath(spaceOf(kBodyShare * robot.box_m), step_out, zones, {}).isFree())
    return check;
  return navigation::checkPath(spaceOf(box), Path(path.begin() + 1, path.end()), zones, bounds);
}

void Mission::Impl::acceptExploration(const RunningJob& job, const PlanOutcome& outcome) {
  if (outcome.plan.status != planners::PlanStatus::kOk) return onNoPlan(job, outcome.plan);
  const bool splices = active && now <= job.takes_over_s + 1e-6;
  const bool stands =
      !active && (input.latest()->pose.position - job.pose.position).norm() < kStartGap_m;
  if (!splices && !stands)
    return refuse("the plan came too late: its start lies behind the robot",
                  planners::PathOutcome::kRejectedUnsafe);
  if (!isWalkable(outcome.plan.path))
    return refuse("refused the planner's path: no footing along it",
                  planners::PathOutcome::kRejectedUnsafe);
  const auto check = checkProposal(outcome.plan.path);
  if (!check.isFree())
    return refuse("refused the planner's path: " + std::string(navigation::toText(check.fault)) +
                      (check.zone.empty() ? "" : " '" + check.zone + "'"),
                  planners::PathOutcome::kRejectedUnsafe);
  const Path whole = joined(job, outcome.plan.path);
  const bool has_home = outcome.home.status == planners::PlanStatus::kOk;
  const double length = lengthOf(whole);
  const double affordable =
      affordableLength(whole, has_home ? std::optional<Path>(outcome.home.path) : std::nullopt);
  const bool is_local = outcome.plan.kind == planners::PathKind::kLocal;
  if (affordable < length && (!is_local || affordable < kShortestCut_m))
    return refuse("refused the planner's path: no way home from its end fits the endurance",
                  planners::PathOutcome::kRejectedBudget);
  flyProposal(slice(whole, 0.0, affordable), slice(whole, affordable, length), outcome);
}

/// `rest`: of the planner's path, beyond `path`; home from its end is known from there on.
void Mission::Impl::flyProposal(const Path& path, const Path& rest, const PlanOutcome& outcome) {
  fly(path, outcome.plan.kind, robot.box_m);
  noteRoute(rest, outcome.home);
  failures = 0;
  last_accept_s = now;
  last_outcome = planners::PathOutcome::kReplaced;
  status.reason = outcome.plan.reason;
}

/// Only what can be flown as a whole, with a known way home from its end, is worth turning round.
void Mission::Impl::acceptSecondLook(const RunningJob& job, const PlanOutcome& outcome) {
  next_look_s = now + kLookPeriod_s;
  if (outcome.plan.status == planners::PlanStatus::kNothingToGain) may_look_again = false;
  const bool is_usable = outcome.plan.status == planners::PlanStatus::kOk &&
                         outcome.home.status == planners::PlanStatus::kOk && active &&
                         now <= job.takes_over_s + 1e-6;
  if (!is_usable || !isWalkable(outcome.plan.path) || !checkProposal(outcome.plan.path).isFree() ||
      !isWayClear(outcome.home.path, robot.box_m))
    return;
  const Path whole = joined(job, outcome.plan.path);
  const double there_s = navigation::travelTime(whole, limitsOf(robot));
  const double home_s = navigation::travelTime(outcome.home.path, limitsOf(robot));
  if (guard.marginAfter(there_s, home_s) < 0.0) return;
  goal = Goal::kExplore;
  flyProposal(whole, {}, outcome);
  status.reason = "affordable again on the way home: " + outcome.plan.reason;
}

double Mission::Impl::affordableLength(const Path& path, const std::optional<Path>& home_path) {
  const MotionLimits limits_of_robot = limitsOf(robot);
  const double length = lengthOf(path);
  const double home_from_end =
      home_path ? navigation::travelTime(*home_path, limits_of_robot) : guard.remaining();
  for (double end = length; end > 0.0; end -= kCutStep_m) {
    const Path part = slice(path, 0.0, end);
    const double there_s = navigation::travelTime(part, limits_of_robot);
    const double onward_s = home_from_end + (length - end) / limits_of_robot.speed_mps;
    const double home_s = std::min(there_s + way_home_s, onward_s);
    if (guard.marginAfter(there_s, home_s) >= 0.0) return end;
  }
  return 0.0;
}

void Mission::Impl::refuse(const std::string& why, planners::PathOutcome outcome) {
  ++status.refused_paths;
  last_outcome = outcome;
  last_reason = why;
  if (active) {
    next_ask_s = now + kRetryInFlight_s;
    status.reason = why;
    return;
  }
  if (outcome == planners::PathOutcome::kRejectedBudget && ++failures >= 3)
    return goHome("home by endurance: no further path leaves a way home", HomeCause::kEndurance);
  onFailedPlan(why);
}

void Mission::Impl::onNoPlan(const RunningJob& job, const planners::PlanResult& plan) {
  if (!job.from_standstill) {
    next_ask_s = now + kRetryInFlight_s;
    if (active) next_ask_s = std::min(next_ask_s, active->endTime() + 0.1);
    return;
  }
  if (plan.status == planners::PlanStatus::kNothingToGain)
    return goHome("explored: " + plan.reason, HomeCause::kOther);
  if (plan.status == planners::PlanStatus::kBudgetSaysHome)
    return goHome("home by endurance: " + plan.reason, HomeCause::kEndurance);
  onFailedPlan(std::string(planners::toText(plan.status)) + ": " + plan.reason);
}

void Mission::Impl::onFailedPlan(const std::string& why) {
  next_ask_s = now + kRetryPeriod_s;
  if (++failures >= kFailuresBeforeHome) return goHome("no plan found: " + why, HomeCause::kOther);
  hold_since_s = now;
  enter(MissionState::kHold, "no plan (" + why + "): trying again");
}

Trajectory Mission::Impl::smoothest(const Path& path, const navigation::MotionStart& start,
                                    const Eigen::Vector3d& box) {
  const MotionLimits limits_of_robot = limitsOf(robot);
  map::ConfigurationSpace& space = spaceOf(box);
  for (const double tolerance : kCornerTolerances_m) {
    Trajectory trajectory = navigation::timed(path, limits_of_robot, start, tolerance);
    Path line;
    for (const TrajectoryPoint& point : trajectory) line.push_back(point.pose);
    line = pathOf(navigation::straightened(line, kLineTolerance_m));
    if (navigation::checkPath(space, line, no_go, {}).isFree()) return trajectory;
  }
  const bool is_tight = box.x() < robot.box_m.x();
  return navigation::timed(path, limits_of_robot, start,
                           is_tight ? kTightTolerance_m : kLeastTolerance_m);
}

void Mission::Impl::fly(const Path& path, planners::PathKind kind, const Eigen::Vector3d& box,
                        const Eigen::Vector3d& corner_box) {
  navigation::MotionStart start{now, Eigen::Vector3d::Zero(), 0.0};
  Path whole = path;
  if (active) {
    const TrajectoryPoint motion = active->reference(now);
    start = {now, motion.velocity, motion.yaw_rate};
    whole.front() = motion.pose;
  } else {
    whole.front() = input.latest()->pose;
  }
  Trajectory trajectory = smoothest(whole, start, corner_box);
  active.emplace(whole, trajectory, kind, box, map.params().resolution_m);
  command = Command{std::move(whole), std::move(trajectory), kind};
  next_refresh_s = now;
  asks_navigation = false;
  switch (kind) {
    case planners::PathKind::kLocal:
      return enter(MissionState::kExplore, "local path");
    case planners::PathKind::kReposition:
      return enter(MissionState::kReposition, "repositioning");
    case planners::PathKind::kHome:
      return enter(MissionState::kHome, "flying home");
  }
}

}  // namespace spelunk::mission
