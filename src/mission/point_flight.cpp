#include "spelunk/mission/point_flight.h"

#include <algorithm>
#include <utility>

#include "spelunk/navigation/rounded_curve.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

using Kind = PointStep::Kind;

constexpr double kLookPeriod_s = 0.5;  // a plan is long: looking at all of it costs
constexpr double kLookAround_s = 1.0;  // at the end of what is known, before giving up on the path
constexpr double kEnd_m = 1e-6;
constexpr double kWorthTakingUp_m = 1.0;  // less of a plan is only taken up at its end
constexpr double kShortestLeg_m = 0.3;    // from a standstill
constexpr double kProgress_m = 0.5;       // the robot has got somewhere
constexpr int kFruitlessMax = 12;         // plans from about the same place
constexpr double kUnseenAhead_m = 0.1;    // from the box to what did not come into view ...
constexpr double kUnseenHalf_m = 0.3;     // ... and half the edge of what is avoided around it
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

PointStep stepOf(Kind kind, const std::string& why = "") { return {kind, {}, why}; }

}  // namespace

void PointFlight::begin(const PointJob& job, double now_s) {
  task_.emplace();
  task_->job = job;
  status_ = {};
  status_.outcome = GoToOutcome::kUnderway;
  status_.target = job.query.goal.position - Eigen::Vector3d(0.0, 0.0, basis_.robot.box_lift_m);
  status_.started_s = now_s;
}

void PointFlight::end(GoToOutcome outcome, const std::string& why, double now_s) {
  if (!task_) return;
  task_.reset();
  status_.outcome = outcome;
  status_.reason = why;
  status_.ended_s = now_s;
}

void PointFlight::reset() {
  task_.reset();
  status_ = {};
}

std::optional<navigation::NavigationAnswer> PointFlight::plan() const {
  if (!task_) return std::nullopt;
  return task_->plan;
}

void PointFlight::noteHeld(planners::PathOutcome outcome) {
  if (!task_) return;
  task_->cause = outcome == planners::PathOutcome::kBlocked ? Cause::kObstacle : Cause::kDeviation;
  if (outcome == planners::PathOutcome::kNone) task_->fruitless = 0;
}

void PointFlight::noteOccupied(const std::vector<map::VoxelIndex>& voxels) {
  if (task_ && task_->monitor && task_->monitor->firstHit(voxels)) task_->is_suspect = true;
}

/// The pseudo-code of execution (Akbari 2021, section IV): fly what is known of the plan, take up
/// more as it is seen, stop and plan anew from here where that is not possible.
PointStep PointFlight::step(const WayHome& way_home, double now_s) {
  if (basis_.flight.active()) return lookAhead(way_home, now_s);
  const bool is_flown = task_->taken_up_m >= lengthOf(task_->plan.path) - kEnd_m;
  if (task_->cause == Cause::kNone && is_flown)
    return stepOf(Kind::kReached, "reached the point that was asked for");
  if (!basis_.flight.isAtRest(basis_.watch.state().velocity, now_s)) return {};
  if (task_->cause == Cause::kNone) {
    const PointStep more = takeUpMore(way_home, now_s);
    const bool may_still_see = now_s < task_->stopped_s + kLookAround_s;
    if (more.kind != Kind::kNothing || may_still_see) return more;
    if (task_->cause == Cause::kNone) noteUnseen();
  }
  return replan();
}

PointStep PointFlight::lookAhead(const WayHome& way_home, double now_s) {
  task_->stopped_s = basis_.flight.active()->endTime();
  if (now_s < task_->next_look_s) return {};
  task_->next_look_s = now_s + kLookPeriod_s;
  if (task_->is_suspect && isPlanBlocked()) task_->cause = Cause::kObstacle;
  task_->is_suspect = false;
  PointStep more;
  if (task_->cause == Cause::kNone) more = takeUpMore(way_home, now_s);
  if (more.kind != Kind::kNothing || task_->cause != Cause::kObstacle) return more;
  return stepOf(Kind::kStop, "new obstacle on the way ahead: stopped, planning anew");
}

/// Whether something occupied lies anywhere on what is left of the plan.
bool PointFlight::isPlanBlocked() const {
  const Path& path = task_->plan.path;
  const double here = project(path, basis_.watch.pose().position).arc_m;
  const Path rest = slice(path, here, lengthOf(path));
  map::ConfigurationSpace& open = basis_.space.of(basis_.robot.box_m, map::Passable::kNotOccupied);
  for (std::size_t i = 1; i < rest.size(); ++i)
    if (!open.isSweepFree(rest[i - 1].position, rest[i].position)) return true;
  return false;
}

PointStep PointFlight::takeUpMore(const WayHome& way_home, double now_s) {
  const double length = lengthOf(task_->plan.path);
  if (task_->taken_up_m >= length - kEnd_m) return {};
  const Path rest = slice(task_->plan.path, task_->taken_up_m, length);
  const Zones& zones = basis_.space.zones();
  const auto check =
      navigation::checkPath(basis_.space.of(basis_.robot.box_m), rest, zones.all(), zones.bounds());
  if (!check.isFree() && check.fault != navigation::PathFault::kUnknown) {
    task_->cause = Cause::kObstacle;
    return {};
  }
  const double least = basis_.flight.active() ? kWorthTakingUp_m : kShortestLeg_m;
  if (!check.isFree() && check.arc_m < least) return {};
  return legOf(task_->taken_up_m, task_->taken_up_m + check.arc_m, way_home, now_s);
}

PointStep PointFlight::legOf(double from_m, double to_m, const WayHome& way_home, double now_s) {
  const Path part = slice(task_->plan.path, from_m, to_m);
  if (!basis_.space.isWalkable(part))
    return stepOf(Kind::kUnreachable, "no footing along the way to the point");
  Path whole;
  if (basis_.flight.active()) {
    const Path ahead = basis_.flight.rest(now_s);
    for (const Eigen::Vector3d& point : navigation::straightened(ahead, kLineTolerance_m))
      whole.push_back({point, 0.0});
  }
  whole = joined(std::move(whole), part);
  if (way_home.affordableLength(whole, std::nullopt) < lengthOf(whole))
    return stepOf(Kind::kUnreachable,
                  "no way home from farther on the way to the point fits the endurance");
  const Eigen::Vector3d& box = basis_.robot.box_m;
  PointStep step{Kind::kFly, Leg(std::move(whole), planners::PathKind::kReposition, box), ""};
  step.leg.corner_box = box + Eigen::Vector3d::Constant(2.0 * task_->plan.safe_distance_m);
  task_->taken_up_m = to_m;
  return step;
}

void PointFlight::noteUnseen() {
  ++status_.replans_unseen;
  const double gap = 0.5 * basis_.robot.box_m.head<2>().norm() + kUnseenAhead_m + kUnseenHalf_m;
  const double ahead = std::min(task_->taken_up_m + gap, lengthOf(task_->plan.path));
  task_->unseen.push_back(unseenAround(poseAt(task_->plan.path, ahead).position));
}

PointStep PointFlight::replan() {
  if (task_->cause == Cause::kObstacle) ++status_.replans_obstacle;
  if (task_->cause == Cause::kDeviation) ++status_.replans_deviation;
  task_->cause = Cause::kNone;
  const Eigen::Vector3d& here = basis_.watch.pose().position;
  if ((here - task_->replanned_at).norm() > kProgress_m) {
    task_->replanned_at = here;
    task_->fruitless = 0;
  }
  if (++task_->fruitless > kFruitlessMax)
    return stepOf(Kind::kUnreachable,
                  "given up: " + std::to_string(kFruitlessMax) + " plans led nowhere from here");
  return stepOf(Kind::kAsk);
}

PointJob PointFlight::job(const std::shared_ptr<const map::FrozenMap>& map, const Rng& rng) {
  navigation::NavigationQuery& query = task_->job.query;
  query.map = map;
  query.start = basis_.watch.pose();
  query.bounds = basis_.space.zones().bounds();
  query.zones = basis_.space.zones().all();
  for (const NoGoZone& zone : task_->unseen)
    if (!sweptBoxMeets(zone, query.start.position, query.start.position, basis_.robot.box_m))
      query.zones.push_back(zone);  // where the robot stands is no place to avoid
  query.rng = rng;
  return task_->job;
}

PointStep PointFlight::take(const navigation::NavigationAnswer& answer, const WayHome& way_home,
                            double now_s) {
  status_.planning_s += 1e-3 * answer.planning_ms;
  if (answer.status != navigation::NavigationStatus::kOk) {
    if (!task_->unseen.empty() && task_->fruitless < kFruitlessMax) {
      task_->unseen.clear();  // what did not come into view from there may from here
      ++task_->fruitless;
      return stepOf(Kind::kAsk);
    }
    status_.nearest_reachable = answer.nearest_reachable;
    if (status_.nearest_reachable) status_.nearest_reachable->z() -= basis_.robot.box_lift_m;
    return stepOf(Kind::kUnreachable, answer.reason);
  }
  task_->plan = answer;
  task_->monitor.emplace(answer.path, basis_.robot.box_m, basis_.space.resolution());
  task_->taken_up_m = 0.0;
  task_->is_suspect = false;
  task_->stopped_s = now_s;
  const Path known = slice(answer.path, 0.0, answer.known_length_m);
  const auto check = basis_.space.checkProposal(known);
  const double length = check.isFree() ? answer.known_length_m : check.arc_m;
  const bool is_whole = length >= lengthOf(answer.path) - kEnd_m;
  if (!is_whole && length < kShortestLeg_m) return {};
  return legOf(0.0, length, way_home, now_s);
}

}  // namespace spelunk::mission
