#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "spelunk/sim/flight_controller.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// One box-shaped rigid body in a static mesh, in double precision (Bullet; stays inside the .cpp).
/// Gravity acts; contact with the mesh pushes back with friction. Not thread-safe.
class RigidBody {
 public:
  struct Shape {
    double mass_kg = 1.0;
    Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Ones();  ///< Principal, along the box's axes.
    Eigen::Vector3d size_m = Eigen::Vector3d::Ones();        ///< Full extents.
    double friction = 0.3;  ///< Of body and mesh alike; 0.3 slides along a wall, not catching.
  };

  /// The body starts at rest.
  RigidBody(const WorldMesh& mesh, const Shape& shape, const Eigen::Vector3d& position,
            const Eigen::Quaterniond& orientation);
  ~RigidBody();
  RigidBody(RigidBody&&) noexcept;

  /// One fixed step under `thrust` along base z, `torque_nm` in the base frame and
  /// `outer_force_n` in the world frame.
  void step(double step_s, const Wrench& wrench, const Eigen::Vector3d& outer_force_n);

  [[nodiscard]] BodyState state() const;

  /// Whether the body touched the mesh in the last step.
  [[nodiscard]] bool isInContact() const;

  /// What the mesh pushed the body with in the last step: the sum of the normal forces, world
  /// frame, newtons.
  [[nodiscard]] Eigen::Vector3d contactForce() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::sim
