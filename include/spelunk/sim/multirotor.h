#pragma once

#include "spelunk/sim/rigid_body.h"
#include "spelunk/sim/rotors.h"
#include "spelunk/sim/simulator.h"
#include "spelunk/sim/vehicle.h"

namespace spelunk::sim {

/// A body with 4 or 6 rotors under the geometric controller.
class Multirotor : public Vehicle {
 public:
  /// Hovers at `start`. Throws OutsideError if the body meets the mesh there.
  Multirotor(const SimParams& params, const WorldMesh& mesh, const MeshScene& scene,
             const Pose& start);

  void step(double step_s, double time_s, const BodyState& estimate, MotionReference& reference,
            Power power) override;
  [[nodiscard]] BodyState state() const override { return body_.state(); }
  [[nodiscard]] bool isInContact() const override { return body_.isInContact(); }
  [[nodiscard]] Eigen::Vector3d bodySize() const override { return size_m_; }

 private:
  Airframe airframe_;
  Rotors rotors_;
  RigidBody body_;
  Eigen::Vector3d size_m_;
};

}  // namespace spelunk::sim
