#include "spelunk/sim/multirotor.h"

#include "spelunk/sim/start_check.h"

namespace spelunk::sim {

Multirotor::Multirotor(const SimParams& params, const WorldMesh& mesh, const MeshScene& scene,
                       const Pose& start)
    : airframe_{params.mass_kg, params.inertia_kgm2, params.drag_coefficient,
                params.thrust_to_weight * params.mass_kg * kGravity},
      rotors_(params.rotors, params.rotor_arm_m, params.rotor_lag_s, airframe_.thrust_max_n),
      body_(mesh, {params.mass_kg, params.inertia_kgm2, params.body_m}, start.position,
            Eigen::Quaterniond(Eigen::AngleAxisd(start.yaw, Eigen::Vector3d::UnitZ()))),
      size_m_(params.body_m) {
  requireFreeBody(scene, mesh, start.position, params.body_m, "sim.body_m");
  rotors_.spinUp(params.mass_kg * kGravity);
}

void Multirotor::step(double step_s, double time_s, const BodyState& estimate,
                      MotionReference& reference, Power power) {
  const TrajectoryPoint ahead = reference.at(time_s + kAccelerationPreview, estimate);
  rotors_.command(
      power == Power::kOff
          ? Wrench{}
          : computeWrench(airframe_, estimate, reference.at(time_s, estimate), ahead.acceleration));
  rotors_.advance(step_s);
  body_.step(step_s, rotors_.wrench(), -airframe_.drag_coefficient * body_.state().velocity);
}

}  // namespace spelunk::sim
