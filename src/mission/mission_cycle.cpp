#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mission_impl.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr double kInputSilence_s = 1.0;
constexpr double kScanAgeMax_s = 2.0;
constexpr double kRestSpeed_mps = 0.2;
constexpr double kSettleMax_s = 4.0;
constexpr double kArrived_m = 0.4;
constexpr double kArrivalGrace_s = 3.0;
constexpr double kStopMargin_m = 0.6;
constexpr double kRefreshPeriod_s = 0.5;
constexpr double kLagMax_m = 2.0;
constexpr double kLagRetimed_m = 0.4;
constexpr double kRetimePeriod_s = 2.0;

std::string withNumber(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

Mission::Impl::Impl(const MissionParams& mission_params, const RobotModel& robot_model,
                    const map::MapParams& map_params, std::uint64_t seed,
                    const terrain::TerrainParams& terrain_params)
    : params(mission_params),
      robot(robot_model),
      map(map_params),
      rng(Rng(seed).fork("mission")),
      input(robot_model.speed_max_mps),
      guard({mission_params.reserve_s, mission_params.reserve_percent, mission_params.pessimism}) {
  if (kindOf(robot) == RobotKind::kLegged) terrain.emplace(terrain_params);
}

std::optional<Command> Mission::Impl::tick(double now_s) {
  now = now_s;
  updateRemaining();
  noteAbortedGoTo();
  if (!isFlying()) return takeCommand();
  checkInputs();
  checkDeviation();
  checkArrival();
  checkAhead();
  checkGround();
  stepBackOff();
  checkEndurance();
  stepHome();
  stepGoTo();
  askForPlan();
  return takeCommand();
}

void Mission::Impl::updateRemaining() {
  const double flown = started_s ? now - *started_s : 0.0;
  guard.report(reported_remaining_s.value_or(std::max(0.0, endurance_at_start_s - flown)));
  status.time_s = now;
  status.remaining_s = guard.remaining();
  if (home_graph && now >= next_refresh_s) {
    refreshWayHome();
    next_refresh_s = now + kRefreshPeriod_s;
  }
}

bool Mission::Impl::isFlying() const { return goal != Goal::kNone; }

std::optional<Command> Mission::Impl::takeCommand() {
  std::optional<Command> taken = std::move(command);
  command.reset();
  if (!taken) return taken;
  taken->path = ofBase(std::move(taken->path));
  for (TrajectoryPoint& point : taken->trajectory) point.pose.position.z() -= robot.box_lift_m;
  return taken;
}

Path Mission::Impl::ofBase(Path path) const {
  for (Pose& pose : path) pose.position.z() -= robot.box_lift_m;
  return path;
}

void Mission::Impl::say(LogLevel level, const std::string& key, const std::string& text) {
  status.reason = text;
  if (throttle.allows(key, now)) log(level, text);
}

void Mission::Impl::enter(MissionState next, const std::string& why) {
  status.reason = why;
  if (state == next) return;
  state = next;
  status.state = next;
  char stamp[32];
  std::snprintf(stamp, sizeof stamp, "%.1f s: ", now);
  log(LogLevel::kInfo, stamp + std::string(toText(next)) + ": " + why);
}

void Mission::Impl::hold(const std::string& why, planners::PathOutcome outcome) {
  if (active || state != MissionState::kHold) command = Command{};
  if (active && active->kind() != planners::PathKind::kHome) {
    last_outcome = outcome;
    last_reason = why;
    if (go_to)
      go_to->cause = outcome == planners::PathOutcome::kBlocked ? ReplanCause::kObstacle
                                                                : ReplanCause::kDeviation;
  }
  active.reset();
  route.reset();
  pending.reset();
  running.reset();
  if (goal == Goal::kHome) wants_way_home = true;  // the trail leads there, but maybe not shortest
  hold_since_s = now;
  next_refresh_s = now;
  enter(MissionState::kHold, why);
}

void Mission::Impl::checkInputs() {
  std::string problem;
  if (input_fault) {
    problem = *input_fault;
  } else if (!last_odometry_s || now - *last_odometry_s > kInputSilence_s) {
    problem = "no odometry for more than 1 s: check the state estimation";
  } else if (last_scan_s && now - *last_scan_s > kInputSilence_s) {
    problem = "no scan for more than 1 s: check the sensor";
  } else if (last_scan_s && scanAge() > kScanAgeMax_s) {
    problem = withNumber("scans come in %.1f s late: the computer or the network is overloaded",
                         scanAge());
  }
  inputs_ok = problem.empty();
  if (inputs_ok) return;
  if (active) {
    hold(problem, planners::PathOutcome::kDeviated);
  } else {
    say(LogLevel::kWarn, "input", problem);
  }
  next_ask_s = now + 0.5;
}

void Mission::Impl::checkDeviation() {
  if (!active) return;
  const Eigen::Vector3d& position = input.latest()->pose.position;
  const double behind = (position - active->reference(now).pose.position).norm();
  if (terrain && behind > kLagRetimed_m && !backs_off) return checkLag();
  if (behind <= params.deviation_max_m) return;
  leavePath(behind);
}

/// A robot that walks may fall behind its trajectory but not leave its line: what is left of the
/// line is timed anew from where it is.
void Mission::Impl::checkLag() {
  const double now_arc = active->arcAt(now);
  const double arc = active->nearestArc(input.latest()->pose.position, now_arc - kLagMax_m,
                                        now_arc + kLagRetimed_m);
  const Path rest = active->line(arc, active->length());
  const double gap = distance(rest.front(), input.latest()->pose);
  if (gap > params.deviation_max_m) return leavePath(gap);
  if (now < next_retime_s) return;
  next_retime_s = now + kRetimePeriod_s;
  const planners::PathKind kind = active->kind();
  const Eigen::Vector3d box = active->box();
  const std::string reason = status.reason;
  active.reset();
  running.reset();
  pending.reset();
  fly(rest, kind, box);
  status.reason = reason;
}

void Mission::Impl::leavePath(double gap_m) {
  ++status.replans_deviation;
  hold(withNumber("the robot is %.2f m off its path: holding and planning anew", gap_m),
       planners::PathOutcome::kDeviated);
}

void Mission::Impl::checkArrival() {
  if (!active || now < active->endTime()) return;
  const double gap =
      (input.latest()->pose.position - active->trajectory().back().pose.position).norm();
  if (gap > kArrived_m && now < active->endTime() + kArrivalGrace_s) return;
  if (active->kind() != planners::PathKind::kHome) last_outcome = planners::PathOutcome::kReached;
  active.reset();
  next_ask_s = std::min(next_ask_s, now);
}

void Mission::Impl::checkAhead() {
  if (!active || !active->blockedAt()) return;
  const double arc = active->arcAt(now);
  const double speed = active->reference(now).velocity.norm();
  const double gap = *active->blockedAt() - arc;
  if (gap > brakingDistance(robot, speed) + kStopMargin_m) return;
  const Path rest = active->line(arc, active->length());
  const auto check =
      navigation::checkPath(spaceOf(active->box()), rest,
                            active->kind() == planners::PathKind::kHome ? given_zones : no_go, {});
  if (check.isFree()) return active->clearBlock();
  active->setBlockedAt(arc + check.arc_m);
  if (check.arc_m > brakingDistance(robot, speed) + kStopMargin_m) return;
  ++status.replans_obstacle;
  hold(withNumber("new obstacle %.1f m ahead on the path: stopped, planning anew", gap),
       planners::PathOutcome::kBlocked);
}

void Mission::Impl::checkEndurance() {
  if (goal != Goal::kExplore && goal != Goal::kGoTo) return;
  if (guard.margin(way_home_s) < 0.0)
    goHome("home by endurance: the way home takes what is left", HomeCause::kEndurance);
}

bool Mission::Impl::isAtRest() const {
  return input.latest()->velocity.norm() < kRestSpeed_mps || now - hold_since_s > kSettleMax_s;
}

}  // namespace spelunk::mission
