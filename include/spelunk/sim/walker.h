#pragma once

#include <array>
#include <vector>

#include "spelunk/common/robot_model.h"
#include "spelunk/sim/rigid_body.h"
#include "spelunk/sim/simulator.h"
#include "spelunk/sim/stepping.h"
#include "spelunk/sim/trunk_posture.h"
#include "spelunk/sim/vehicle.h"
#include "spelunk/sim/walk_tracker.h"
#include "spelunk/sim/walker_start.h"

namespace spelunk::sim {

/// A trunk in contact with the mesh on four legs without mass. The legs' forces follow from a
/// balance controller; what the ground does not give, the trunk does not get: it tilts, touches,
/// falls. A robot that has fallen lies there.
class Walker : public Vehicle {
 public:
  /// Stands on the ground below `start`. Keeps a reference to `scene`. Throws OutsideError if
  /// `params` have problems, there is no ground to stand on, it is too steep or the trunk meets the
  /// mesh there.
  Walker(const WalkerParams& params, const RobotModel& robot, const WorldMesh& mesh,
         const MeshScene& scene, const Pose& start);

  void step(double step_s, double time_s, const BodyState& estimate, MotionReference& reference,
            Power power) override;
  [[nodiscard]] BodyState state() const override { return body_.state(); }
  [[nodiscard]] bool isInContact() const override { return body_.isInContact(); }
  [[nodiscard]] Eigen::Vector3d bodySize() const override { return params_.trunk_m; }

  void take(Posture posture) { posture_.take(posture); }

  [[nodiscard]] WalkerCount count() const {
    return {has_fallen_ ? 1 : 0, stepping_.slips(), stepping_.trips()};
  }
  [[nodiscard]] JointState joints() const;
  [[nodiscard]] std::vector<FootState> feet() const;

 private:
  Walker(const WalkerParams& params, const RobotModel& robot, const WorldMesh& mesh,
         const MeshScene& scene, const Stance& stance);
  void control(double step_s, double time_s, const BodyState& estimate, MotionReference& reference);
  void push(double step_s);
  [[nodiscard]] bool hasLostBalance() const;
  void watchForFall(double step_s);
  void updateJoints(const BodyState& trunk);

  WalkerParams params_;
  RigidBody body_;
  Stepping stepping_;
  TrunkPosture posture_;
  WalkTracker tracker_;
  std::array<Leg, kLegs> legs_;
  std::array<LegAngles, kLegs> angles_;
  std::vector<Eigen::Vector3d> forces_;  ///< One a standing foot, world frame.
  double since_control_s_ = 1.0;
  double on_ground_s_ = 0.0;
  bool is_limp_ = false;  ///< Once limp, for good.
  bool has_fallen_ = false;
};

}  // namespace spelunk::sim
