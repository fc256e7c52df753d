#include "spelunk/sim/stepping.h"

#include <algorithm>
#include <cmath>

namespace spelunk::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCapture_s = 0.16;         ///< A metre a second too fast sets feet so far ahead;
constexpr double kCaptureAtRest_s = 0.12;   ///< less while standing, lest steps rock the trunk.
constexpr double kLeastSwing = 0.4;         ///< A step begins while so much of its time is left.
constexpr double kSearchPeriod_s = 0.05;    ///< A foot without a place looks for one so often ...
constexpr double kSearchSwing_s = 0.15;     ///< ... and needs so long to get there.
constexpr double kLookPeriod_s = 0.03;      ///< A swinging foot's place is looked at so often ...
constexpr double kRedirectUntil = 0.6;      ///< ... for so much of its time ...
constexpr double kRedirect_m = 0.03;        ///< ... and changed if it lies elsewhere by more.
constexpr double kStoop_m = 0.08;           ///< The trunk lowers so far within a swing.
constexpr double kRestOff_m = 0.06;         ///< Standing, feet may be so far from their place.
constexpr double kTuck_m = 0.05;            ///< A foot without a place is drawn up so far.
constexpr double kSlideResistance = 300.0;  ///< N s/m of a sliding foot.
constexpr double kSlideMax_mps = 1.0;
constexpr double kSlip_m = 0.03;  ///< A slide that counts.
constexpr double kSlideDepth_m = 0.15;

}  // namespace

/// What one step of the clock knows of the trunk.
struct Stepping::Motion {
  Motion(double step, const BodyState& body, const DriveCommand& wanted)
      : step_s(step), trunk(body), command(wanted) {
    T_world_base = Isometry3d::Identity();
    T_world_base.translate(body.position);
    T_world_base.rotate(body.orientation);
    const Vector3d ahead = body.orientation * Vector3d::UnitX();
    heading = ahead.head<2>().normalized();
    velocity = turned({wanted.forward_mps, wanted.sideways_mps});
    const bool stands = velocity.isZero() && wanted.yaw_rate_radps == 0.0;
    capture_s = stands ? kCaptureAtRest_s : kCapture_s;
  }

  /// From the heading frame to the world.
  [[nodiscard]] Vector2d turned(const Vector2d& v) const {
    return {heading.x() * v.x() - heading.y() * v.y(), heading.y() * v.x() + heading.x() * v.y()};
  }

  /// Under the hip in the middle of the next stance, half a stance's way ahead, and further where
  /// the trunk is faster than commanded (Raibert 1986, "Legged robots that balance", chapter 2).
  [[nodiscard]] Vector3d placeFor(const Leg& leg, double after_s, double stance_s) const {
    const double turn = command.yaw_rate_radps * after_s;
    const Vector2d root = turned(leg.root().head<2>());
    const Vector2d side(-root.y(), root.x());
    const Vector2d later = root + turn * side;
    const Vector2d spin = command.yaw_rate_radps * side;
    Vector3d place = trunk.position;
    place.head<2>() += after_s * velocity + later + 0.5 * stance_s * (velocity + spin) +
                       capture_s * (trunk.velocity.head<2>() - velocity);
    return place;
  }

  [[nodiscard]] Isometry3d poseAfter(double after_s) const {
    Isometry3d pose = Isometry3d::Identity();
    pose.translate(trunk.position + after_s * Vector3d(velocity.x(), velocity.y(), 0.0));
    pose.rotate(Eigen::AngleAxisd(command.yaw_rate_radps * after_s, Vector3d::UnitZ()) *
                trunk.orientation);
    return pose;
  }

  double step_s;
  BodyState trunk;
  DriveCommand command;
  Isometry3d T_world_base;
  Vector2d heading;
  Vector2d velocity;  ///< Commanded, world frame.
  double capture_s;
};

Stepping::Stepping(const WalkerParams& params, const MeshScene& scene,
                   const std::array<Foothold, kLegs>& holds)
    : legs_(legsOf(params)),
      ground_(scene, params),
      gait_(params),
      swing_height_(params.swing_height_m),
      friction_(params.friction_coefficient),
      force_max_(params.foot_force_max_n),
      is_walk_(params.gait == "walk") {
  for (std::size_t k = 0; k < kLegs; ++k) {
    feet_[k].position = holds[k].position;
    feet_[k].hold = holds[k];
  }
}

bool Stepping::wantsToStep(const Motion& motion) const {
  const DriveCommand& command = motion.command;
  if (command.forward_mps != 0.0 || command.sideways_mps != 0.0 || command.yaw_rate_radps != 0.0)
    return true;
  for (std::size_t k = 0; k < kLegs; ++k) {
    const Vector3d place = motion.placeFor(legs_[k], 0.0, 0.0);
    if (feet_[k].phase != FootPhase::kStance ||
        (place - feet_[k].position).head<2>().norm() > kRestOff_m)
      return true;
  }
  return false;
}

bool Stepping::canLift(std::size_t leg) const {
  for (std::size_t k = 0; k < kLegs; ++k) {
    const bool is_partner = !is_walk_ && k + leg == kLegs - 1;  // the diagonal one
    if (k != leg && !is_partner && feet_[k].phase != FootPhase::kStance) return false;
  }
  return true;
}

void Stepping::advance(double step_s, const BodyState& trunk, const DriveCommand& command) {
  const Motion motion(step_s, trunk, command);
  T_base_world_ = motion.T_world_base.inverse();
  const bool wants_to_step = wantsToStep(motion);
  if (!was_stepping_ && wants_to_step) gait_.restart();
  was_stepping_ = wants_to_step;
  gait_.advance(step_s);
  for (std::size_t k = 0; k < kLegs; ++k) {
    if (gait_.isStance(k)) feet_[k].has_stepped = false;
    switch (feet_[k].phase) {
      case FootPhase::kStance:
        stand(k, motion, wants_to_step);
        break;
      case FootPhase::kSwing:
        swing(k, motion);
        break;
      case FootPhase::kSearching:
        search(k, motion);
        break;
    }
  }
}

void Stepping::stand(std::size_t leg, const Motion& motion, bool wants_to_step) {
  Foot& foot = feet_[leg];
  if (!legs_[leg].anglesFor(T_base_world_ * foot.position)) return giveUp(leg);
  if (!wants_to_step || foot.has_stepped) return;
  const double left_s = gait_.swingLeft(leg);
  if (left_s < kLeastSwing * gait_.swingTime() || !canLift(leg)) return;
  foot.has_stepped = true;
  if (!aimAt(leg, motion, left_s)) giveUp(leg);
}

bool Stepping::aimAt(std::size_t leg, const Motion& motion, double duration_s) {
  const Vector3d place = motion.placeFor(legs_[leg], duration_s, gait_.stanceTime());
  Isometry3d T_world_base = motion.poseAfter(duration_s);
  auto hold = ground_.find(legs_[leg], T_world_base, place);
  if (!hold) {
    T_world_base.translation().z() -= kStoop_m;
    hold = ground_.find(legs_[leg], T_world_base, place);
  }
  if (!hold) return false;
  Foot& foot = feet_[leg];
  foot.hold = *hold;
  foot.phase = FootPhase::kSwing;
  foot.curve =
      SwingCurve(foot.position, hold->position, swing_height_, motion.trunk.position.z(), ground_);
  foot.aim = place;
  foot.next_look_s = kLookPeriod_s;
  foot.swung_s = 0.0;
  foot.swing_s = duration_s;
  return true;
}

/// The trunk may move otherwise than it did when the foot left the ground.
void Stepping::redirect(std::size_t leg, const Motion& motion) {
  Foot& foot = feet_[leg];
  if (foot.swung_s > kRedirectUntil * foot.swing_s || foot.swung_s < foot.next_look_s) return;
  foot.next_look_s = foot.swung_s + kLookPeriod_s;
  const double left_s = foot.swing_s - foot.swung_s;
  const Vector3d place = motion.placeFor(legs_[leg], left_s, gait_.stanceTime());
  if ((place - foot.aim).head<2>().norm() < kRedirect_m) return;
  foot.aim = place;
  const auto hold = ground_.find(legs_[leg], motion.poseAfter(left_s), place);
  if (!hold) return;
  foot.hold = *hold;
  foot.curve.redirect(foot.swung_s / foot.swing_s, hold->position, motion.trunk.position.z(),
                      ground_);
}

void Stepping::swing(std::size_t leg, const Motion& motion) {
  Foot& foot = feet_[leg];
  foot.swung_s += motion.step_s;
  redirect(leg, motion);
  const Vector3d next = foot.curve.at(std::min(1.0, foot.swung_s / foot.swing_s));
  if (foot.curve.crosses(foot.swung_s / foot.swing_s) &&
      ground_.isRockBetween(foot.position, next)) {
    ++trips_;
    return giveUp(leg);
  }
  foot.position = next;
  if (foot.swung_s < foot.swing_s) return;
  foot.position = foot.hold.position;
  if (!legs_[leg].anglesFor(T_base_world_ * foot.position)) return giveUp(leg);
  foot.phase = FootPhase::kStance;
  foot.slid_m = 0.0;
}

void Stepping::giveUp(std::size_t leg) {
  Foot& foot = feet_[leg];
  foot.phase = FootPhase::kSearching;
  foot.hang = T_base_world_ * foot.position;
  foot.hang.z() += kTuck_m;
  foot.swung_s = 0.0;
}

void Stepping::search(std::size_t leg, const Motion& motion) {
  Foot& foot = feet_[leg];
  foot.position = motion.T_world_base * foot.hang;
  foot.swung_s += motion.step_s;
  if (foot.swung_s < kSearchPeriod_s) return;
  foot.swung_s = 0.0;
  (void)aimAt(leg, motion, kSearchSwing_s);
}

Footing Stepping::footing() const {
  const auto is_searching = [](const Foot& foot) { return foot.phase == FootPhase::kSearching; };
  return std::any_of(feet_.begin(), feet_.end(), is_searching) ? Footing::kWanting
                                                               : Footing::kComplete;
}

FootPoints Stepping::grounds() const {
  FootPoints points;
  for (std::size_t k = 0; k < kLegs; ++k)
    points[k] = feet_[k].phase == FootPhase::kStance ? feet_[k].position : feet_[k].hold.position;
  return points;
}

std::vector<FootContact> Stepping::contacts(const BodyState& trunk) const {
  std::vector<FootContact> contacts;
  for (const Foot& foot : feet_)
    if (foot.phase == FootPhase::kStance)
      contacts.push_back({foot.position - trunk.position, foot.hold.normal});
  return contacts;
}

void Stepping::slide(Foot& foot, const Vector3d& excess_n, double step_s) {
  const double speed = std::min(kSlideMax_mps, excess_n.norm() / kSlideResistance);
  const Vector3d moved = foot.position - speed * step_s * excess_n.normalized();
  const auto ground =
      ground_.groundBelow(moved + 0.5 * kSlideDepth_m * Vector3d::UnitZ(), kSlideDepth_m);
  const bool had_slipped = foot.slid_m >= kSlip_m;
  foot.slid_m += speed * step_s;
  if (!had_slipped && foot.slid_m >= kSlip_m) ++slips_;
  if (!ground) return;
  foot.hold = *ground;
  foot.position = ground->position;
}

std::vector<Vector3d> Stepping::held(double step_s, const std::vector<Vector3d>& forces) {
  std::vector<Vector3d> held;
  std::size_t next = 0;
  for (Foot& foot : feet_) {
    if (foot.phase != FootPhase::kStance) continue;
    Vector3d force = forces[next++];
    if (const double size = force.norm(); size > force_max_) force *= force_max_ / size;
    const double pressure = std::max(0.0, force.dot(foot.hold.normal));
    Vector3d along = force - force.dot(foot.hold.normal) * foot.hold.normal;
    const double excess = along.norm() - friction_ * pressure;
    if (excess > 0.0) {
      const Vector3d direction = along.normalized();
      along -= excess * direction;
      force = pressure * foot.hold.normal + along;
      slide(foot, excess * direction, step_s);
    }
    held.push_back(force);
  }
  return held;
}

}  // namespace spelunk::sim
