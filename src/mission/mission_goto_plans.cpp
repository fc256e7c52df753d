#include <algorithm>

#include "mission_impl.h"
#include "spelunk/navigation/rounded_curve.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr double kWorthTakingUp_m = 1.0;  // less of a plan is only taken up at its end
constexpr double kShortestLeg_m = 0.3;    // from a standstill
constexpr double kEnd_m = 1e-6;
constexpr double kProgress_m = 0.5;
constexpr int kFruitlessMax = 12;
constexpr double kUnseenAhead_m = 0.1;  // from the box to what did not come into view ...
constexpr double kUnseenHalf_m = 0.3;   // ... and half the edge of what is avoided around it
constexpr double kLineTolerance_m = 0.02;

NoGoZone unseenAround(const Eigen::Vector3d& place) {
  NoGoZone zone;
  zone.name = "unseen";
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    zone.polygon.emplace_back(place.x() + x * kUnseenHalf_m, place.y() + y * kUnseenHalf_m);
  zone.z_min = place.z() - kUnseenHalf_m;
  zone.z_max = place.z() + kUnseenHalf_m;
  return zone;
}

}  // namespace

/// Whether something occupied lies anywhere on what is left of the plan.
bool Mission::Impl::isPlanBlocked() {
  const double here = project(go_to->plan.path, input.latest()->pose.position).arc_m;
  const Path rest = slice(go_to->plan.path, here, lengthOf(go_to->plan.path));
  map::ConfigurationSpace& open = spaceOf(robot.box_m, map::Passable::kNotOccupied);
  for (std::size_t i = 1; i < rest.size(); ++i)
    if (!open.isSweepFree(rest[i - 1].position, rest[i].position)) return true;
  return false;
}

void Mission::Impl::takeUpMore() {
  const double length = lengthOf(go_to->plan.path);
  if (go_to->taken_up_m >= length - kEnd_m) return;
  const Path rest = slice(go_to->plan.path, go_to->taken_up_m, length);
  const auto check = navigation::checkPath(spaceOf(robot.box_m), rest, no_go, limits);
  if (!check.isFree() && check.fault != navigation::PathFault::kUnknown) {
    go_to->cause = ReplanCause::kObstacle;
    return;
  }
  const double least = active ? kWorthTakingUp_m : kShortestLeg_m;
  if (!check.isFree() && check.arc_m < least) return;
  const std::string problem = flyPlan(go_to->taken_up_m, go_to->taken_up_m + check.arc_m);
  if (!problem.empty()) endGoTo(GoToOutcome::kUnreachable, problem);
}

std::string Mission::Impl::flyPlan(double from_m, double to_m) {
  const Path part = slice(go_to->plan.path, from_m, to_m);
  if (!isWalkable(part)) return "no footing along the way to the point";
  Path whole;
  if (active) {
    const Path ahead = active->line(active->arcAt(now), active->length());
    for (const Eigen::Vector3d& point : navigation::straightened(ahead, kLineTolerance_m))
      whole.push_back({point, 0.0});
  }
  for (const Pose& pose : part)
    if (whole.empty() || distance(whole.back(), pose) > kEnd_m) whole.push_back(pose);
  if (affordableLength(whole, std::nullopt) < lengthOf(whole))
    return "no way home from farther on the way to the point fits the endurance";
  fly(whole, planners::PathKind::kReposition, robot.box_m,
      robot.box_m + Eigen::Vector3d::Constant(2.0 * go_to->plan.safe_distance_m));
  go_to->taken_up_m = to_m;
  return "";
}

void Mission::Impl::noteUnseen() {
  ++status.go_to.replans_unseen;
  const double gap = 0.5 * robot.box_m.head<2>().norm() + kUnseenAhead_m + kUnseenHalf_m;
  const double ahead = std::min(go_to->taken_up_m + gap, lengthOf(go_to->plan.path));
  go_to->unseen.push_back(unseenAround(poseAt(go_to->plan.path, ahead).position));
}

void Mission::Impl::replan() {
  if (go_to->cause == ReplanCause::kObstacle) ++status.go_to.replans_obstacle;
  if (go_to->cause == ReplanCause::kDeviation) ++status.go_to.replans_deviation;
  go_to->cause = ReplanCause::kNone;
  const Eigen::Vector3d& here = input.latest()->pose.position;
  if ((here - go_to->replanned_at).norm() > kProgress_m) {
    go_to->replanned_at = here;
    go_to->fruitless = 0;
  }
  if (++go_to->fruitless > kFruitlessMax)
    return endGoTo(GoToOutcome::kUnreachable,
                   "given up: " + std::to_string(kFruitlessMax) + " plans led nowhere from here");
  askForWay();
}

void Mission::Impl::askForWay() {
  frozen = map.freeze();
  home_graph->connect(frozen);
  RunningJob job;
  job.number = next_job++;
  job.explore = false;
  job.from_standstill = true;
  job.asked_s = job.takes_over_s = now;
  job.pose = input.latest()->pose;
  navigation::NavigationQuery& query = go_to->job.query;
  query.map = frozen;
  query.start = job.pose;
  query.bounds = limits;
  query.zones = no_go;
  for (const NoGoZone& zone : go_to->unseen)
    if (!sweptBoxMeets(zone, query.start.position, query.start.position, robot.box_m))
      query.zones.push_back(zone);  // where the robot stands is no place to avoid
  query.rng = rng.fork("go_to/" + std::to_string(job.number));
  PlanJob plan;
  plan.number = job.number;
  plan.explore = false;
  plan.go_to = go_to->job;
  pending = std::move(plan);
  running = job;
}

void Mission::Impl::acceptGoTo(const navigation::NavigationAnswer& answer) {
  if (answer.status == navigation::NavigationStatus::kOk) return installPlan(answer);
  status.go_to.planning_s += 1e-3 * answer.planning_ms;
  if (!go_to->unseen.empty() && go_to->fruitless < kFruitlessMax) {
    go_to->unseen.clear();  // what did not come into view from there may from here
    ++go_to->fruitless;
    return askForWay();
  }
  status.go_to.nearest_reachable = answer.nearest_reachable;
  if (status.go_to.nearest_reachable) status.go_to.nearest_reachable->z() -= robot.box_lift_m;
  endGoTo(GoToOutcome::kUnreachable, answer.reason);
}

void Mission::Impl::installPlan(const navigation::NavigationAnswer& answer) {
  status.go_to.planning_s += 1e-3 * answer.planning_ms;
  go_to->plan = answer;
  go_to->monitor.emplace(answer.path, robot.box_m, map.params().resolution_m);
  go_to->taken_up_m = 0.0;
  go_to->is_suspect = false;
  go_to->stopped_s = now;
  const Path known = slice(answer.path, 0.0, answer.known_length_m);
  const auto check = checkProposal(known);
  const double length = check.isFree() ? answer.known_length_m : check.arc_m;
  const bool is_whole = length >= lengthOf(answer.path) - kEnd_m;
  if (!is_whole && length < kShortestLeg_m) return;
  const std::string problem = flyPlan(0.0, length);
  if (!problem.empty()) endGoTo(GoToOutcome::kUnreachable, problem);
}

}  // namespace spelunk::mission
