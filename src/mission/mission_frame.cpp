#include "spelunk/mission/mission_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace spelunk::mission {
namespace {

constexpr double kSlackVoxels = 2.0;  // noise of an estimator; less does a map no harm
constexpr double kYawSlack_rad = 2.0 * M_PI / 180.0;
/// Estimators drift by some hundredths of the way; what is corrected is not more than that.
constexpr double kDriftShare = 0.1;
constexpr double kFirstCorrection_m = 1.0;  // of an estimator that has just begun
/// A SLAM closes a loop now and then; what jumps more often is broken, or comes from two.
constexpr std::size_t kCorrectionsMax = 5;
constexpr double kCorrectionsWindow_s = 20.0;
constexpr double kKeptPast_s = 30.0;  // no scan comes later
constexpr double kStill_mps = 1e-3;   // an estimator that fills in no velocity

}  // namespace

MissionFrame::MissionFrame(const RobotModel& robot, double resolution_m)
    : robot_(robot), slack_m_(kSlackVoxels * resolution_m) {}

void MissionFrame::place(const LocalFrame& frame) {
  now_ = frame;
  past_.clear();
  last_.reset();
}

/// Where the robot should be now by the velocities of the last report and of this one.
Pose MissionFrame::predicted(const RobotState& report) const {
  const double step_s = report.stamp_s - last_->stamp_s;
  // The turn of a correction is in the new velocity, not in the old one: their mean is as the robot
  // moves only in its own frame.
  const Shift to_last(Eigen::Vector3d(Eigen::Vector3d::Zero()),
                      last_->pose.yaw + last_->yaw_rate * step_s - report.pose.yaw);
  Pose pose = last_->pose;
  pose.position += 0.5 * step_s * (last_->velocity + to_last.turned(report.velocity));
  pose.yaw = wrapAngle(pose.yaw + 0.5 * step_s * (last_->yaw_rate + report.yaw_rate));
  return pose;
}

bool MissionFrame::isMotion(const Pose& predicted, const RobotState& report) const {
  const double step_s = report.stamp_s - last_->stamp_s;
  const bool has_speed = last_->velocity.norm() + report.velocity.norm() > kStill_mps;
  const double unseen_mps = has_speed ? 0.5 * (report.velocity - last_->velocity).norm() +
                                            0.25 * robot_.acceleration_max_mps2 * step_s
                                      : robot_.speed_max_mps;
  const double unseen_radps = has_speed ? 0.5 * std::abs(report.yaw_rate - last_->yaw_rate) +
                                              0.25 * robot_.yaw_acceleration_max_radps2 * step_s
                                        : robot_.yaw_rate_max_radps;
  return distance(predicted, report.pose) <= slack_m_ + unseen_mps * step_s &&
         std::abs(wrapAngle(report.pose.yaw - predicted.yaw)) <=
             kYawSlack_rad + unseen_radps * step_s;
}

bool MissionFrame::isPlausible(const Pose& predicted, const RobotState& report) {
  while (!corrected_s_.empty() && corrected_s_.front() < report.stamp_s - kCorrectionsWindow_s)
    corrected_s_.pop_front();
  return corrected_s_.size() < kCorrectionsMax &&
         distance(predicted, report.pose) <= kFirstCorrection_m + kDriftShare * travelled_m_;
}

std::optional<std::string> MissionFrame::take(const RobotState& report) {
  if (!isFinite(report.pose) || !report.velocity.allFinite() || !std::isfinite(report.yaw_rate) ||
      !std::isfinite(report.stamp_s))
    return std::nullopt;
  if (!last_ || report.stamp_s <= last_->stamp_s) {
    last_ = report;
    return std::nullopt;
  }
  const Pose expected = predicted(report);
  const RobotState before = *last_;
  const bool is_motion = isMotion(expected, report);
  const bool is_correction = !is_motion && isPlausible(expected, report);
  last_ = report;
  travelled_m_ += is_motion ? distance(before.pose, report.pose) : 0.0;
  if (!is_correction) return std::nullopt;
  correction_ = shiftBetween(expected, report.pose);
  past_.push_back({now_, before.stamp_s, report.stamp_s});
  while (past_.front().corrected_s < report.stamp_s - kKeptPast_s) past_.pop_front();
  now_ = now_.corrected(correction_);
  corrected_s_.push_back(report.stamp_s);
  ++corrections_;
  char text[200];
  std::snprintf(text, sizeof text,
                "odometry was corrected by %.2f m and %.1f degrees: map, trail and home move with "
                "the robot",
                distance(expected, report.pose), correction_.yaw_rad * 180.0 / M_PI);
  return text;
}

std::optional<LocalFrame> MissionFrame::at(double stamp_s) const {
  for (const Past& past : past_) {
    if (stamp_s <= past.until_s) return past.frame;
    if (stamp_s < past.corrected_s) return std::nullopt;
  }
  return now_;
}

}  // namespace spelunk::mission
