#include "spelunk/sim/motion_reference.h"

#include <algorithm>
#include <cmath>

namespace spelunk::sim {
namespace {

Eigen::Isometry3d toIsometry(const BodyState& body) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(body.position);
  transform.rotate(body.orientation);
  return transform;
}

TrajectoryPoint motionOf(const BodyState& body) {
  TrajectoryPoint point;
  point.pose = poseOf(toIsometry(body));
  point.velocity = body.velocity;
  point.yaw_rate = (body.orientation * body.angular_velocity).z();
  return point;
}

}  // namespace

DriveCommand clamped(const DriveCommand& command, const DriveLimits& limits) {
  return {std::clamp(command.forward_mps, -limits.backward_mps, limits.forward_mps),
          std::clamp(command.sideways_mps, -limits.sideways_mps, limits.sideways_mps),
          std::clamp(command.yaw_rate_radps, -limits.yaw_rate_radps, limits.yaw_rate_radps)};
}

MotionReference::MotionReference(const Pose& start, double braking_mps2)
    : braking_mps2_(braking_mps2) {
  TrajectoryPoint hold;
  hold.pose = start;
  trajectory_ = {hold};
}

void MotionReference::follow(Trajectory trajectory, double time_s, const BodyState& estimate) {
  drive_.reset();
  delay_s_ = 0.0;
  trajectory_ = trajectory.empty() ? brakingTrajectory(time_s, motionOf(estimate), braking_mps2_)
                                   : std::move(trajectory);
}

void MotionReference::drive(const DriveCommand& command, double time_s) {
  drive_ = command;
  drive_until_s_ = time_s + kDriveTimeout;
}

void MotionReference::update(double time_s, const BodyState& estimate) {
  if (drive_ && time_s > drive_until_s_) follow({}, time_s, estimate);
}

TrajectoryPoint MotionReference::at(double time_s, const BodyState& estimate) const {
  if (!drive_) return stateAt(trajectory_, time_s - delay_s_);
  TrajectoryPoint point;
  point.time_s = time_s;
  point.pose = motionOf(estimate).pose;
  const double c = std::cos(point.pose.yaw);
  const double s = std::sin(point.pose.yaw);
  point.velocity = {c * drive_->forward_mps - s * drive_->sideways_mps,
                    s * drive_->forward_mps + c * drive_->sideways_mps, 0.0};
  point.yaw_rate = drive_->yaw_rate_radps;
  return point;
}

}  // namespace spelunk::sim
