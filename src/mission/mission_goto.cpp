#include "mission_impl.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr double kStartGap_m = 0.5;
constexpr double kLookPeriod_s = 0.5;
constexpr double kLookAround_s = 1.0;  // at the end of what is known, before giving up on the path
constexpr double kEnd_m = 1e-6;

}  // namespace

std::optional<navigation::NavigationQuery> Mission::Impl::goToQuery(const Eigen::Vector3d& point) {
  if (!input.latest()) return std::nullopt;
  if (!home_graph && startProblem().empty()) markStandFree();
  navigation::NavigationQuery query;
  query.map = map.freeze();
  query.start = input.latest()->pose;
  query.goal = {point + Eigen::Vector3d(0.0, 0.0, robot.box_lift_m), query.start.yaw};
  query.box = robot.box_m;
  query.bounds = limits;
  query.zones = no_go;
  query.trees = navigation::TreeDetail::kKeep;  // people look at them
  return query;
}

std::string Mission::Impl::goToProblem(const Eigen::Vector3d& point) {
  if (!point.allFinite()) return "the point holds a number that is not finite";
  if (state == MissionState::kEStop) return "emergency stop is on: start releases it";
  if (isFlying()) return "the mission is running: pause it first";
  const std::string problem = startProblem();
  if (!problem.empty()) return problem;
  if (!isAtRest()) return "the robot still moves: wait until it holds";
  const Eigen::Vector3d& here = input.latest()->pose.position;
  const Eigen::Vector3d home = home_graph ? home_graph->home().position : here;
  const double there_s = (point - here).norm() / robot.speed_max_mps;
  const double home_s = (point - home).norm() / robot.speed_max_mps;
  if (guard.marginAfter(there_s, home_s) < 0.0)
    return "the point is too far: not even the straight way there and home fits the endurance";
  return "";
}

Answer Mission::Impl::goTo(const navigation::NavigationParams& navigation_params,
                           const navigation::NavigationQuery& query,
                           const navigation::NavigationAnswer& answer) {
  const Eigen::Vector3d lift(0.0, 0.0, robot.box_lift_m);
  const Eigen::Vector3d point = query.goal.position - lift;
  const std::string problem = goToProblem(point);
  if (!problem.empty()) return {false, problem};
  if (answer.status != navigation::NavigationStatus::kOk) return {false, answer.reason};
  if (distance(query.start, input.latest()->pose) > kStartGap_m)
    return {false, "the path does not begin where the robot is"};
  takeOff();
  refreshWayHome();
  goal = Goal::kGoTo;
  go_to.emplace();
  go_to->job = {navigation_params, query};
  status.go_to = {};
  status.go_to.outcome = GoToOutcome::kUnderway;
  status.go_to.target = point;
  status.go_to.started_s = now;
  installPlan(answer);
  if (status.go_to.outcome == GoToOutcome::kUnderway)
    return {true, "flying to the point that was asked for"};
  return {false, status.go_to.reason};
}

/// The pseudo-code of execution (Akbari 2021, section IV): fly what is known of the plan, take up
/// more as it is seen, stop and plan anew from here where that is not possible.
void Mission::Impl::stepGoTo() {
  if (goal != Goal::kGoTo || running || pending || !inputs_ok) return;
  if (active) return lookAhead();
  const bool is_flown = go_to->taken_up_m >= lengthOf(go_to->plan.path) - kEnd_m;
  if (go_to->cause == ReplanCause::kNone && is_flown)
    return endGoTo(GoToOutcome::kReached, "reached the point that was asked for");
  if (!isAtRest()) return;
  if (go_to->cause == ReplanCause::kNone) {
    takeUpMore();
    const bool may_still_see = now < go_to->stopped_s + kLookAround_s;
    if (active || goal != Goal::kGoTo || may_still_see) return;
    if (go_to->cause == ReplanCause::kNone) noteUnseen();
  }
  replan();
}

void Mission::Impl::lookAhead() {
  go_to->stopped_s = active->endTime();
  if (now < go_to->next_look_s) return;
  go_to->next_look_s = now + kLookPeriod_s;
  if (go_to->is_suspect && isPlanBlocked()) go_to->cause = ReplanCause::kObstacle;
  go_to->is_suspect = false;
  if (go_to->cause == ReplanCause::kNone) takeUpMore();
  if (!active || go_to->cause != ReplanCause::kObstacle) return;
  ++status.replans_obstacle;
  hold("new obstacle on the way ahead: stopped, planning anew", planners::PathOutcome::kBlocked);
}

void Mission::Impl::endGoTo(GoToOutcome outcome, const std::string& why) {
  status.go_to.outcome = outcome;
  status.go_to.reason = why;
  status.go_to.ended_s = now;
  goal = Goal::kNone;
  go_to.reset();
  hold(why, outcome == GoToOutcome::kReached ? planners::PathOutcome::kReached
                                             : planners::PathOutcome::kBlocked);
}

void Mission::Impl::noteAbortedGoTo() {
  if (!go_to || goal == Goal::kGoTo) return;
  go_to.reset();
  status.go_to.outcome = GoToOutcome::kAborted;
  status.go_to.reason = status.reason;
  status.go_to.ended_s = now;
}

std::optional<planners::PlanRequest> Mission::Impl::requestHere(double now_s) {
  if (!input.latest()) return std::nullopt;
  planners::PlanRequest request;
  request.map = map.freeze();
  request.time_s = now_s;
  request.pose = input.latest()->pose;
  request.velocity = input.latest()->velocity;
  request.home = home_graph ? home_graph->home() : request.pose;
  request.remaining_s = guard.disposable(0.0);
  request.bounds = limits;
  request.zones = no_go;
  request.trail = stamped_trail;
  request.budget.iterations = params.max_samples;
  return request;
}

}  // namespace spelunk::mission
