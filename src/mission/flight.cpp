#include "spelunk/mission/flight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spelunk/navigation/rounded_curve.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;

/// Estimators of a robot at rest report less.
constexpr double kRestSpeed_mps = 0.2;
/// After it every robot has come to rest, whatever its estimator says.
constexpr double kSettleMax_s = 4.0;
constexpr double kArrived_m = 0.4;       // half a body: the next path begins there without a step
constexpr double kArrivalGrace_s = 3.0;  // a robot that is late may still come
/// Less is the drift of an estimator, or of a controller that holds.
constexpr double kMoved_m = 0.15;
/// A robot with legs that was timed anew so often without a step does not only turn slowly.
constexpr int kRetimedInPlaceMax = 2;
/// Between the robot's nose and what it stops before.
constexpr double kStopMargin_m = 0.6;
constexpr double kNewest_s = 1e-6;       // a state that is not older is of now
constexpr double kLagMax_m = 2.0;        // how far back on its line a late robot is looked for
constexpr double kLagRetimed_m = 0.4;    // half a body length; less is the controller's work
constexpr double kRetimePeriod_s = 2.0;  // a late robot shall not be timed anew at every tick
/// How far rounded corners may leave the line; the first that stays free is the fastest.
constexpr double kCornerTolerances_m[] = {0.6, 0.3};
constexpr double kLeastTolerance_m = 0.1;   // within a voxel of the line, which was checked
constexpr double kTightTolerance_m = 0.02;  // without its margin the box has no room for more
constexpr double kLineTolerance_m = 0.02;   // points of a timed line that are one straight piece
constexpr double kBackSpeedShare = 0.4;     // of the fastest walk

Path pathOf(const std::vector<Eigen::Vector3d>& points) {
  Path path;
  for (const Eigen::Vector3d& point : points) path.push_back({point, 0.0});
  return path;
}

double lengthOf(const std::vector<navigation::SlowPiece>& pieces) {
  double length = 0.0;
  for (const navigation::SlowPiece& piece : pieces) length += piece.to_m - piece.from_m;
  return length;
}

}  // namespace

bool Flight::goesHome() const { return active_ && active_->kind() == PathKind::kHome; }

Path Flight::rest(double now_s) const {
  return active_ ? active_->line(active_->arcAt(now_s), active_->length()) : Path{};
}

double Flight::restTime(double now_s) const {
  return active_ ? std::max(0.0, active_->endTime() - now_s) : 0.0;
}

Trajectory Flight::smoothest(const Path& path, const navigation::MotionStart& start,
                             const Eigen::Vector3d& box) {
  const MotionLimits limits = this->limits();
  map::ConfigurationSpace& space = space_.of(box);
  const std::vector<navigation::SlowPiece> slow = space_.narrowPieces(path);
  const double narrow_m = lengthOf(slow);
  for (const double tolerance : kCornerTolerances_m) {
    Trajectory trajectory = navigation::timed(path, limits, start, tolerance, slow);
    Path line;
    for (const TrajectoryPoint& point : trajectory) line.push_back(point.pose);
    line = pathOf(navigation::straightened(line, kLineTolerance_m));
    if (navigation::checkPath(space, line, space_.zones().all(), {}).isFree() &&
        lengthOf(space_.narrowPieces(line)) <= narrow_m)
      return trajectory;
  }
  const bool is_tight = box.x() < robot_.box_m.x();
  return navigation::timed(path, limits, start, is_tight ? kTightTolerance_m : kLeastTolerance_m,
                           slow);
}

void Flight::fly(const Leg& leg, const Pose& here, double now_s) {
  navigation::MotionStart start{now_s, Eigen::Vector3d::Zero(), 0.0};
  Path whole = leg.path;
  if (active_) {
    const TrajectoryPoint motion = active_->reference(now_s);
    start = {now_s, motion.velocity, motion.yaw_rate};
    whole.front() = motion.pose;
  } else {
    whole.front() = here;
    sent_from_ = here.position;
  }
  Trajectory trajectory = smoothest(whole, start, leg.corner_box);
  active_.emplace(whole, trajectory, leg.kind, leg.box, space_.resolution());
  command_ = Command{std::move(whole), std::move(trajectory), leg.kind};
  posture_ = Posture::kStand;
}

void Flight::goBack(const Path& way, const Pose& here, double now_s) {
  Path back = way;
  for (Pose& pose : back) pose.yaw = here.yaw + M_PI;  // timed as if it turned its face that way
  MotionLimits limits = this->limits();
  limits.speed_mps *= kBackSpeedShare;
  Trajectory trajectory = navigation::timed(back, limits, {now_s, Eigen::Vector3d::Zero(), 0.0});
  for (TrajectoryPoint& point : trajectory) {
    point.pose.yaw = here.yaw;
    point.yaw_rate = 0.0;
  }
  for (Pose& pose : back) pose.yaw = here.yaw;
  active_.emplace(back, trajectory, PathKind::kLocal, space_.bodyBox(), space_.resolution());
  command_ = Command{std::move(back), std::move(trajectory), PathKind::kLocal};
  posture_ = Posture::kStand;
}

MotionLimits Flight::limits() const {
  MotionLimits limits = limitsOf(robot_);
  limits.speed_mps = std::min(limits.speed_mps, speed_limit_mps_);
  return limits;
}

RobotState Flight::movedOn(const RobotState& seen, double now_s) const {
  RobotState state = seen;
  const double step_s = now_s - seen.stamp_s;
  if (step_s <= kNewest_s) return state;
  state.stamp_s = now_s;
  if (!active_) {
    const double speed = seen.velocity.norm();
    const double braking_s = std::min(step_s, speed / robot_.braking_deceleration_mps2);
    const double left =
        speed > 0.0 ? 1.0 - braking_s * robot_.braking_deceleration_mps2 / speed : 0.0;
    state.pose.position += 0.5 * (1.0 + left) * braking_s * seen.velocity;
    state.velocity *= left;
    state.yaw_rate = 0.0;
    return state;
  }
  const TrajectoryPoint then = active_->reference(seen.stamp_s);
  const TrajectoryPoint now = active_->reference(now_s);
  state.pose.position += now.pose.position - then.pose.position;
  state.pose.yaw = wrapAngle(state.pose.yaw + now.pose.yaw - then.pose.yaw);
  state.velocity += now.velocity - then.velocity;
  state.yaw_rate += now.yaw_rate - then.yaw_rate;
  return state;
}

void Flight::stop(Posture posture) {
  command_ = Command{};
  command_->posture = posture;
  posture_ = posture;
  active_.reset();
  retimed_in_place_ = 0;
}

bool Flight::isAtRest(const Eigen::Vector3d& velocity, double now_s) const {
  return velocity.norm() < kRestSpeed_mps || now_s - hold_since_s_ > kSettleMax_s;
}

Path Flight::joined(const Path& path, double takes_over_s, const Pose& here, double now_s) const {
  if (!active_) {
    Path whole = path;
    whole.front() = here;
    return whole;
  }
  Path whole = active_->line(active_->arcAt(now_s), active_->arcAt(takes_over_s));
  whole.insert(whole.end(), path.begin() + (whole.size() > 1 ? 1 : 0), path.end());
  return whole;
}

/// Only robots with legs may be late: a robot that flies is where its timing says, or off its path.
bool Flight::isLate(const Pose& here, double now_s) const {
  return kindOf(robot_) == RobotKind::kLegged &&
         distance(here, active_->reference(now_s).pose) > kLagRetimed_m;
}

double Flight::nearestArc(const Pose& here, double now_s) const {
  const double now_arc = active_->arcAt(now_s);
  return active_->nearestArc(here.position, now_arc - kLagMax_m, now_arc + kLagRetimed_m);
}

std::optional<double> Flight::gapOffPath(const Pose& here, double now_s) const {
  if (!active_) return std::nullopt;
  double gap = distance(here, active_->reference(now_s).pose);
  if (isLate(here, now_s)) {
    const double arc = nearestArc(here, now_s);
    gap = distance(active_->line(arc, active_->length()).front(), here);
  }
  if (gap <= params_.deviation_max_m) return std::nullopt;
  return gap;
}

std::optional<Leg> Flight::lateRest(const Pose& here, double now_s) {
  if (!active_ || !isLate(here, now_s) || now_s < next_retime_s_) return std::nullopt;
  next_retime_s_ = now_s + kRetimePeriod_s;
  const bool has_moved = (here.position - sent_from_).norm() >= kMoved_m;
  retimed_in_place_ = has_moved ? 0 : retimed_in_place_ + 1;
  return Leg(active_->line(nearestArc(here, now_s), active_->length()), active_->kind(),
             active_->box());
}

bool Flight::hasArrived(const Pose& here, double now_s) const {
  return active_ && now_s >= active_->endTime() &&
         distance(here, active_->trajectory().back().pose) <= kArrived_m;
}

bool Flight::isOverdue(const Pose& here, double now_s) const {
  return active_ && now_s >= active_->endTime() + kArrivalGrace_s && !hasArrived(here, now_s);
}

bool Flight::isIgnored(const Pose& seen, const Pose& here, double now_s) const {
  if (!active_ || (seen.position - sent_from_).norm() >= kMoved_m) return false;
  return gapOffPath(here, now_s) || isOverdue(here, now_s) ||
         retimed_in_place_ >= kRetimedInPlaceMax;
}

void Flight::noteOccupied(const std::vector<map::VoxelIndex>& voxels, double now_s) {
  if (active_) active_->noteOccupied(voxels, now_s);
}

std::optional<double> Flight::findObstacleAhead(double now_s) {
  if (!active_ || !active_->blockedAt()) return std::nullopt;
  const double arc = active_->arcAt(now_s);
  const double speed = active_->reference(now_s).velocity.norm();
  const double stop_m = brakingDistance(robot_, speed) + kStopMargin_m;
  const double gap = *active_->blockedAt() - arc;
  if (gap > stop_m) return std::nullopt;
  const Path ahead = active_->line(arc, active_->length());
  const Zones& zones = space_.zones();
  const auto check = navigation::checkPath(space_.of(active_->box()), ahead,
                                           goesHome() ? zones.given() : zones.all(), {});
  if (check.isFree()) {
    active_->clearBlock();
    return std::nullopt;
  }
  active_->setBlockedAt(arc + check.arc_m);
  if (check.arc_m > stop_m) return std::nullopt;
  return gap;
}

std::optional<Command> Flight::takeCommand() {
  std::optional<Command> taken = std::exchange(command_, std::nullopt);
  if (!taken) return taken;
  return ofBase(std::move(*taken));
}

Command Flight::commandAgain(double now_s) const {
  Command again;
  again.posture = posture_;
  if (!active_ || now_s >= active_->endTime()) return again;
  again.path = rest(now_s);
  again.kind = active_->kind();
  again.trajectory.push_back(active_->reference(now_s));
  for (const TrajectoryPoint& point : active_->trajectory())
    if (point.time_s > now_s) again.trajectory.push_back(point);
  return ofBase(std::move(again));
}

Command Flight::ofBase(Command command) const {
  for (Pose& pose : command.path) pose.position.z() -= robot_.box_lift_m;
  for (TrajectoryPoint& point : command.trajectory) point.pose.position.z() -= robot_.box_lift_m;
  return command;
}

}  // namespace spelunk::mission
