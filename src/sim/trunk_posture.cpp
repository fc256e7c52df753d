#include "spelunk/sim/trunk_posture.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "spelunk/common/pose.h"

namespace spelunk::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGroundLag = 0.15;      ///< Seconds: the plane follows the feet.
constexpr double kHeightLag = 0.10;      ///< Seconds: the height follows the plane.
constexpr double kSlopeMax = 0.7;        ///< Steeper ground no longer tilts the trunk further.
constexpr double kReachShare = 0.97;     ///< Of a leg's length that the trunk's height counts on.
constexpr double kAnchor_m = 0.05;       ///< The wanted position runs ahead of the trunk so far ...
constexpr double kAnchorYaw_rad = 0.15;  ///< ... and the wanted heading.
constexpr double kStoopMax_m = 0.12;     ///< So far the trunk lowers for a foot without a place ...
constexpr double kStoop_mps = 1.0;       ///< ... so fast ...
constexpr double kRise_mps = 0.2;        ///< ... and rises again.
constexpr double kLyingGap_m = 0.07;     ///< Below the trunk: the ground is not that even.
constexpr double kSidewaysMax_mps2 = 3.0;
constexpr double kLiftMin = 0.3;  ///< Vertical force, shares of the weight.
constexpr double kLiftMax = 2.0;

// Gains, by frequency (rad/s) and damping.
constexpr double kAlongStiffness = 16.0;
constexpr double kAlongDamping = 7.0;
constexpr double kHeightStiffness = 100.0;
constexpr double kHeightDamping = 18.0;
constexpr double kTiltStiffness = 160.0;
constexpr double kTiltDamping = 24.0;
constexpr double kYawStiffness = 60.0;
constexpr double kYawDamping = 15.0;

double yawOf(const BodyState& body) {
  const Vector3d ahead = body.orientation * Vector3d::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

}  // namespace

GroundPlane planeThrough(const FootPoints& feet) {
  GroundPlane plane;
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& foot : feet) middle += foot / static_cast<double>(kLegs);
  Eigen::Matrix2d moments = 1e-4 * Eigen::Matrix2d::Identity();
  Vector2d rises = Vector2d::Zero();
  for (const Vector3d& foot : feet) {
    const Vector2d off = (foot - middle).head<2>();
    moments += off * off.transpose();
    rises += (foot.z() - middle.z()) * off;
  }
  plane.origin = middle.head<2>();
  plane.height = middle.z();
  plane.slope = moments.inverse() * rises;
  return plane;
}

Eigen::Quaterniond orientationOn(const Vector3d& normal, double yaw) {
  const Vector3d heading(std::cos(yaw), std::sin(yaw), 0.0);
  const Vector3d y = normal.cross(heading).normalized();
  Matrix3d attitude;
  attitude << y.cross(normal), y, normal;
  return Eigen::Quaterniond(attitude);
}

TrunkPosture::TrunkPosture(const WalkerParams& params, const BodyState& start,
                           const FootPoints& feet)
    : mass_kg_(params.trunk_mass_kg),
      inertia_(trunkInertia(params)),
      stand_height_(params.stand_height_m),
      lowest_height_(0.5 * params.trunk_m.z() + 0.15),
      lying_height_(0.5 * params.trunk_m.z() + kLyingGap_m),
      legs_(legsOf(params)),
      ground_(planeThrough(feet)),
      position_(start.position),
      yaw_(yawOf(start)) {}

/// Lower over uneven ground, by what the feet stand off its plane: so the legs keep the reach to
/// catch the trunk.
double TrunkPosture::wantedHeight(const BodyState& trunk, const FootPoints& feet) const {
  const double plane = ground_.heightAt(trunk.position.head<2>());
  double uneven = 0.0;
  for (const Vector3d& foot : feet)
    uneven = std::max(uneven, std::abs(foot.z() - ground_.heightAt(foot.head<2>())));
  double height = plane + stand_height_ - uneven - stoop_ - lowered_;
  for (std::size_t k = 0; k < kLegs; ++k) {
    const Vector3d root = trunk.orientation * legs_[k].root();
    const double aside = (trunk.position + root - feet[k]).head<2>().norm();
    const double longest = kReachShare * legs_[k].longest();
    const double stretch = std::sqrt(std::max(0.0, longest * longest - aside * aside));
    height = std::min(height, feet[k].z() + stretch - root.z());
  }
  return std::max(height, plane + (lowered_ > 0.0 ? lying_height_ : lowest_height_));
}

void TrunkPosture::advance(double step_s, const BodyState& trunk, const DriveCommand& command,
                           const FootPoints& feet, Footing footing) {
  const double speed = footing == Footing::kWanting ? kStoop_mps : -kRise_mps;
  stoop_ = std::clamp(stoop_ + step_s * speed, 0.0, kStoopMax_m);
  const double lower = wanted_ == Posture::kLie ? kRise_mps : -kRise_mps;
  lowered_ =
      std::clamp(lowered_ + step_s * lower, 0.0, std::max(0.0, stand_height_ - lying_height_));
  const GroundPlane seen = planeThrough(feet);
  const double share = std::min(1.0, step_s / kGroundLag);
  ground_.height = ground_.heightAt(seen.origin);
  ground_.origin = seen.origin;
  ground_.height += share * (seen.height - ground_.height);
  ground_.slope += share * (seen.slope - ground_.slope);
  if (const double steep = ground_.slope.norm(); steep > kSlopeMax)
    ground_.slope *= kSlopeMax / steep;

  const double yaw = yawOf(trunk);
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  velocity_.head<2>() = Vector2d(c * command.forward_mps - s * command.sideways_mps,
                                 s * command.forward_mps + c * command.sideways_mps);
  velocity_.z() = ground_.slope.dot(velocity_.head<2>());
  Vector2d ahead = (position_ - trunk.position).head<2>() + step_s * velocity_.head<2>();
  if (const double far = ahead.norm(); far > kAnchor_m) ahead *= kAnchor_m / far;
  position_.head<2>() = trunk.position.head<2>() + ahead;
  position_.z() += step_s * velocity_.z();
  position_.z() += std::min(1.0, step_s / kHeightLag) * (wantedHeight(trunk, feet) - position_.z());
  yaw_rate_ = command.yaw_rate_radps;
  yaw_ =
      yaw + std::clamp(wrapAngle(yaw_ - yaw) + step_s * yaw_rate_, -kAnchorYaw_rad, kAnchorYaw_rad);
}

TrunkWrench TrunkPosture::wrench(const BodyState& trunk) const {
  const Vector3d off = position_ - trunk.position;
  const Vector3d drift = velocity_ - trunk.velocity;
  Vector3d acceleration = kAlongStiffness * off + kAlongDamping * drift;
  if (const double along = acceleration.head<2>().norm(); along > kSidewaysMax_mps2)
    acceleration.head<2>() *= kSidewaysMax_mps2 / along;
  acceleration.z() = std::clamp(kGravity + kHeightStiffness * off.z() + kHeightDamping * drift.z(),
                                kLiftMin * kGravity, kLiftMax * kGravity);

  const Eigen::Quaterniond wanted = orientationOn(ground_.normal(), yaw_);
  const Eigen::AngleAxisd turn(trunk.orientation.conjugate() * wanted);
  const double angle = wrapAngle(turn.angle());
  const Vector3d rate =
      trunk.orientation.conjugate() * Vector3d(0.0, 0.0, yaw_rate_) - trunk.angular_velocity;
  const Vector3d stiffness(kTiltStiffness, kTiltStiffness, kYawStiffness);
  const Vector3d damping(kTiltDamping, kTiltDamping, kYawDamping);
  const Vector3d angular = stiffness.cwiseProduct(angle * turn.axis()) + damping.cwiseProduct(rate);
  return {mass_kg_ * acceleration, trunk.orientation * inertia_.cwiseProduct(angular)};
}

}  // namespace spelunk::sim
