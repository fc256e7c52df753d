#include "spelunk/sim/walker.h"

#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kControlPeriod_s = 0.0075;  ///< Legs and forces are worked out so often.
constexpr double kTimeTolerance = 1e-9;
constexpr double kTrunkFriction = 0.7;
constexpr double kAssumedFriction = 0.6;  ///< What the robot takes the ground's friction for.
constexpr double kFallenTilt = 0.5;       ///< Cosine of the tilt that counts as a fall: 60 degrees.
constexpr double kFallenTime_s = 0.5;     ///< So long the ground carries the trunk ...
constexpr double kFallenShare = 0.4;      ///< ... with so much of its weight: it has fallen.

constexpr double kWantingSpeed = 0.3;  ///< Share, while a foot has no place.

/// Beyond either the balance is lost and the legs let go, as a real controller's do before a crash.
constexpr double kLostTilt = 0.75;        ///< Cosine of the tilt: 41 degrees.
constexpr double kLostSinking_mps = 1.0;  ///< Downward.

FootPoints positionsOf(const std::array<Foothold, kLegs>& holds) {
  FootPoints points;
  for (std::size_t k = 0; k < kLegs; ++k) points[k] = holds[k].position;
  return points;
}

BodyState atRest(const Stance& stance) {
  BodyState state;
  state.position = stance.position;
  state.orientation = stance.orientation;
  return state;
}

DriveCommand slowed(const DriveCommand& command) {
  return {kWantingSpeed * command.forward_mps, kWantingSpeed * command.sideways_mps,
          kWantingSpeed * command.yaw_rate_radps};
}

WalkerParams checked(const WalkerParams& params) {
  std::string text;
  for (const std::string& problem : params.problems()) text += (text.empty() ? "" : "; ") + problem;
  if (!text.empty()) throw OutsideError(text);
  return params;
}

}  // namespace

Walker::Walker(const WalkerParams& params, const RobotModel& robot, const WorldMesh& mesh,
               const MeshScene& scene, const Pose& start)
    : Walker(params, robot, mesh, scene, standBelow(scene, mesh, checked(params), start)) {}

Walker::Walker(const WalkerParams& params, const RobotModel& robot, const WorldMesh& mesh,
               const MeshScene& scene, const Stance& stance)
    : params_(params),
      body_(mesh, {params.trunk_mass_kg, trunkInertia(params), params.trunk_m, kTrunkFriction},
            stance.position, stance.orientation),
      stepping_(params, scene, stance.holds),
      posture_(params, atRest(stance), positionsOf(stance.holds)),
      tracker_(robot, params),
      legs_(legsOf(params)) {
  updateJoints(body_.state());
}

void Walker::step(double step_s, double time_s, const BodyState& estimate,
                  MotionReference& reference, Power power) {
  is_limp_ = is_limp_ || has_fallen_ || power == Power::kOff || hasLostBalance();
  since_control_s_ += step_s;
  if (!is_limp_ && since_control_s_ >= kControlPeriod_s - kTimeTolerance) {
    control(std::min(since_control_s_, kControlPeriod_s + step_s), time_s, estimate, reference);
    since_control_s_ = 0.0;
  }
  push(step_s);
  if (power == Power::kOn) watchForFall(step_s);
}

void Walker::control(double step_s, double time_s, const BodyState& estimate,
                     MotionReference& reference) {
  const BodyState trunk = body_.state();
  DriveCommand command = tracker_.advance(step_s, time_s, estimate, reference);
  const Footing footing = stepping_.footing();
  if (footing == Footing::kWanting) command = slowed(command);
  stepping_.advance(step_s, trunk, command);
  posture_.advance(step_s, trunk, command, stepping_.grounds(), footing);
  std::vector<FootContact> contacts = stepping_.contacts(trunk);
  for (FootContact& contact : contacts) contact.normal = posture_.ground().normal();
  const std::vector<Vector3d> wanted = distributeForces(posture_.wrench(trunk), contacts,
                                                        kAssumedFriction, params_.foot_force_max_n);
  forces_ = stepping_.held(step_s, wanted);
  updateJoints(trunk);
}

void Walker::push(double step_s) {
  Wrench wrench;
  Vector3d force = Vector3d::Zero();
  if (!is_limp_) {
    const BodyState trunk = body_.state();
    Vector3d torque = Vector3d::Zero();
    const std::vector<FootContact> contacts = stepping_.contacts(trunk);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      force += forces_[k];
      torque += contacts[k].lever.cross(forces_[k]);
    }
    wrench.torque_nm = trunk.orientation.conjugate() * torque;
  }
  body_.step(step_s, wrench, force);
}

bool Walker::hasLostBalance() const {
  const BodyState trunk = body_.state();
  return (trunk.orientation * Vector3d::UnitZ()).z() < kLostTilt ||
         trunk.velocity.z() < -kLostSinking_mps;
}

void Walker::watchForFall(double step_s) {
  if (has_fallen_) return;
  const double upright = (body_.state().orientation * Vector3d::UnitZ()).z();
  const bool lies = body_.contactForce().z() > kFallenShare * params_.trunk_mass_kg * kGravity;
  on_ground_s_ = std::max(0.0, on_ground_s_ + (lies ? step_s : -step_s));
  has_fallen_ = upright < kFallenTilt || on_ground_s_ > kFallenTime_s;
}

void Walker::updateJoints(const BodyState& trunk) {
  for (std::size_t k = 0; k < kLegs; ++k) {
    const Vector3d foot =
        trunk.orientation.conjugate() * (stepping_.feet()[k].position - trunk.position);
    if (const auto angles = legs_[k].anglesFor(foot)) angles_[k] = *angles;
  }
}

JointState Walker::joints() const {
  JointState joints;
  for (std::size_t k = 0; k < kLegs; ++k) {
    for (const char* joint : {"_HAA", "_HFE", "_KFE"})
      joints.names.push_back(std::string(kLegNames[k]) + joint);
    for (const double angle : {angles_[k].abduction, angles_[k].flexion, angles_[k].knee})
      joints.angles.push_back(angle);
  }
  return joints;
}

std::vector<FootState> Walker::feet() const {
  std::vector<FootState> feet;
  for (std::size_t k = 0; k < kLegs; ++k)
    feet.push_back({kLegNames[k], legs_[k].footAt(angles_[k]),
                    !is_limp_ && stepping_.feet()[k].phase == FootPhase::kStance});
  return feet;
}

}  // namespace spelunk::sim
