#include "spelunk/sim/walk_tracker.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/pose.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector2d;

constexpr double kPositionGain = 1.2;  ///< 1/s
constexpr double kYawGain = 1.8;       ///< 1/s
constexpr double kCatchUp = 1.2;       ///< Share of the cruising speed while behind.
constexpr double kRest_m = 0.04;       ///< Nearer to a resting reference the robot stands ...
constexpr double kRest_rad = 0.05;
constexpr double kWake = 2.5;        ///< ... until it is so many times farther off.
constexpr double kLagFree_m = 0.12;  ///< Farther behind, the reference slows down ...
constexpr double kLagMax_m = 0.35;   ///< ... and waits.

double approached(double value, double target, double change) {
  return value + std::clamp(target - value, -change, change);
}

/// `command` shortened, its direction kept, until it is within `limits`.
Vector2d shortened(const Vector2d& command, const DriveLimits& limits) {
  const double forward = command.x() > 0.0 ? limits.forward_mps : limits.backward_mps;
  const double over =
      std::max(std::abs(command.x()) / forward, std::abs(command.y()) / limits.sideways_mps);
  return over > 1.0 ? Vector2d(command / over) : command;
}

}  // namespace

DriveLimits walkingLimits(const RobotModel& robot, const WalkerParams& params) {
  return {robot.speed_max_mps, params.backward_share * robot.speed_max_mps,
          params.sideways_share * robot.speed_max_mps, robot.yaw_rate_max_radps};
}

WalkTracker::WalkTracker(const RobotModel& robot, const WalkerParams& params)
    : limits_(walkingLimits(robot, params)),
      acceleration_(robot.acceleration_max_mps2),
      yaw_acceleration_(robot.yaw_acceleration_max_radps2) {
  limits_.forward_mps *= kCatchUp;
  limits_.backward_mps *= kCatchUp;
  limits_.sideways_mps *= kCatchUp;
}

DriveCommand WalkTracker::advance(double step_s, double time_s, const BodyState& estimate,
                                  MotionReference& reference) {
  const TrajectoryPoint point = reference.at(time_s, estimate);
  const Eigen::Vector3d ahead = estimate.orientation * Eigen::Vector3d::UnitX();
  const Vector2d heading = ahead.head<2>().normalized();
  const Vector2d off = (point.pose.position - estimate.position).head<2>();
  const double yaw_off = wrapAngle(point.pose.yaw - std::atan2(ahead.y(), ahead.x()));
  const double lag = std::clamp((off.norm() - kLagFree_m) / (kLagMax_m - kLagFree_m), 0.0, 1.0);
  reference.holdBack(lag * step_s);

  const Vector2d velocity = (1.0 - lag) * point.velocity.head<2>() + kPositionGain * off;
  const double yaw_rate = (1.0 - lag) * point.yaw_rate + kYawGain * yaw_off;
  const bool is_moving = point.velocity.head<2>().norm() > 0.0 || point.yaw_rate != 0.0;
  const double wake = is_resting_ ? kWake : 1.0;
  is_resting_ = !is_moving && off.norm() < wake * kRest_m && std::abs(yaw_off) < wake * kRest_rad;

  const Vector2d wanted = shortened(
      {heading.dot(velocity), heading.x() * velocity.y() - heading.y() * velocity.x()}, limits_);
  const double change = acceleration_ * step_s;
  const double turn = std::clamp(yaw_rate, -limits_.yaw_rate_radps, limits_.yaw_rate_radps);
  command_.forward_mps = approached(command_.forward_mps, is_resting_ ? 0.0 : wanted.x(), change);
  command_.sideways_mps = approached(command_.sideways_mps, is_resting_ ? 0.0 : wanted.y(), change);
  command_.yaw_rate_radps =
      approached(command_.yaw_rate_radps, is_resting_ ? 0.0 : turn, yaw_acceleration_ * step_s);
  return command_;
}

}  // namespace spelunk::sim
