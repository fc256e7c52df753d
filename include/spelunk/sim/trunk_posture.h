#pragma once

#include <Eigen/Geometry>
#include <array>

#include "spelunk/common/posture.h"
#include "spelunk/sim/flight_controller.h"
#include "spelunk/sim/force_distribution.h"
#include "spelunk/sim/leg_kinematics.h"
#include "spelunk/sim/motion_reference.h"

namespace spelunk::sim {

using FootPoints = std::array<Eigen::Vector3d, kLegs>;  ///< World frame.

/// The plane z = height + slope * (xy - origin) under the feet.
struct GroundPlane {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double height = 0.0;
  [[nodiscard]] double heightAt(const Eigen::Vector2d& xy) const {
    return height + slope.dot(xy - origin);
  }
  [[nodiscard]] Eigen::Vector3d normal() const {
    return Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
  }
};

/// The plane with the least squared heights off four points.
[[nodiscard]] GroundPlane planeThrough(const FootPoints& feet);

/// World from base with z along `normal` and x as near to the heading as that allows.
[[nodiscard]] Eigen::Quaterniond orientationOn(const Eigen::Vector3d& normal, double yaw);

/// kWanting: a foot has no place to stand.
enum class Footing { kComplete, kWanting };

/// How the trunk is held: at a height above the plane of the feet, along it, moving as commanded.
class TrunkPosture {
 public:
  TrunkPosture(const WalkerParams& params, const BodyState& start, const FootPoints& feet);

  /// Moves the wanted posture on by `step_s` at `command`; `feet` are where the feet stand or are
  /// about to. While the footing is wanting the trunk stoops, so that feet reach lower ground.
  void advance(double step_s, const BodyState& trunk, const DriveCommand& command,
               const FootPoints& feet, Footing footing = Footing::kComplete);

  /// Lies down, or stands up, from now on.
  void take(Posture posture) { wanted_ = posture; }

  /// Force and torque that the feet must give: weight, feedback on posture and velocity.
  [[nodiscard]] TrunkWrench wrench(const BodyState& trunk) const;

  [[nodiscard]] const GroundPlane& ground() const { return ground_; }

 private:
  [[nodiscard]] double wantedHeight(const BodyState& trunk, const FootPoints& feet) const;

  double mass_kg_;
  Eigen::Vector3d inertia_;
  double stand_height_;
  double lowest_height_;
  double lying_height_;
  std::array<Leg, kLegs> legs_;
  GroundPlane ground_;
  double stoop_ = 0.0;    ///< Below its usual height, metres.
  double lowered_ = 0.0;  ///< The same on the way to lying.
  Posture wanted_ = Posture::kStand;
  Eigen::Vector3d position_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  double yaw_;
  double yaw_rate_ = 0.0;
};

}  // namespace spelunk::sim
