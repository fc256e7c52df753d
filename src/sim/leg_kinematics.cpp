#include "spelunk/sim/leg_kinematics.h"

#include <cmath>

#include "spelunk/common/pose.h"

namespace spelunk::sim {
namespace {

constexpr double kDegree = M_PI / 180.0;

double lengthAt(double thigh, double shank, double knee) {
  return std::sqrt(thigh * thigh + shank * shank + 2.0 * thigh * shank * std::cos(knee));
}

}  // namespace

Leg::Leg(const WalkerParams& params, std::size_t index)
    : thigh_(params.thigh_m),
      shank_(params.shank_m),
      abduction_max_(params.abduction_max_deg * kDegree),
      flexion_max_(params.flexion_max_deg * kDegree),
      knee_min_(params.knee_min_deg * kDegree),
      knee_max_(params.knee_max_deg * kDegree) {
  const double front = index < 2 ? 1.0 : -1.0;
  const double left = index % 2 == 0 ? 1.0 : -1.0;
  hip_ = params.hip_m.cwiseProduct(Eigen::Vector3d(front, left, 1.0));
  link_ = left * params.abduction_link_m;
  knee_side_ = -front;
  longest_ = lengthAt(thigh_, shank_, knee_min_);
  shortest_ = lengthAt(thigh_, shank_, knee_max_);
}

Eigen::Vector3d Leg::root() const { return hip_ + Eigen::Vector3d(0.0, link_, 0.0); }

Eigen::Vector3d Leg::footAt(const LegAngles& angles) const {
  const double below = angles.flexion + angles.knee;
  const double x = -thigh_ * std::sin(angles.flexion) - shank_ * std::sin(below);
  const double z = -thigh_ * std::cos(angles.flexion) - shank_ * std::cos(below);
  const double c = std::cos(angles.abduction);
  const double s = std::sin(angles.abduction);
  return hip_ + Eigen::Vector3d(x, c * link_ - s * z, s * link_ + c * z);
}

std::optional<LegAngles> Leg::anglesFor(const Eigen::Vector3d& foot) const {
  const Eigen::Vector3d p = foot - hip_;
  const double across_squared = p.y() * p.y() + p.z() * p.z() - link_ * link_;
  if (across_squared < 0.0) return std::nullopt;
  const double z = -std::sqrt(across_squared);
  LegAngles angles;
  angles.abduction = wrapAngle(std::atan2(p.z(), p.y()) - std::atan2(z, link_));
  const double length_squared = p.x() * p.x() + z * z;
  const double cosine =
      (length_squared - thigh_ * thigh_ - shank_ * shank_) / (2.0 * thigh_ * shank_);
  if (cosine < -1.0 || cosine > 1.0) return std::nullopt;
  const double bend = std::acos(cosine);
  angles.knee = knee_side_ * bend;
  angles.flexion =
      wrapAngle(std::atan2(-p.x(), -z) - std::atan2(shank_ * std::sin(angles.knee),
                                                    thigh_ + shank_ * std::cos(angles.knee)));
  if (std::abs(angles.abduction) > abduction_max_ || std::abs(angles.flexion) > flexion_max_ ||
      bend < knee_min_ || bend > knee_max_)
    return std::nullopt;
  return angles;
}

std::array<Leg, kLegs> legsOf(const WalkerParams& params) {
  return {Leg(params, 0), Leg(params, 1), Leg(params, 2), Leg(params, 3)};
}

}  // namespace spelunk::sim
