#include "spelunk/sim/rigid_body.h"

#include <btBulletDynamicsCommon.h>

#include <vector>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

using Construction = btRigidBody::btRigidBodyConstructionInfo;

constexpr double kRestitution = 0.1;
constexpr double kMeshMargin = 0.005;  ///< Metres from the mesh at which contact begins.

btVector3 toBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d toEigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// One body needs none of the thousands of preallocated slots.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return info;
}

/// Bullet reads both in place: they must outlive the shape.
std::unique_ptr<btTriangleIndexVertexArray> inPlace(const std::vector<Eigen::Vector3f>& vertices,
                                                    const std::vector<Eigen::Vector3i>& indices) {
  btIndexedMesh part;
  part.m_numTriangles = static_cast<int>(indices.size());
  part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices.data());
  part.m_triangleIndexStride = sizeof(Eigen::Vector3i);
  part.m_numVertices = static_cast<int>(vertices.size());
  part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
  part.m_vertexStride = sizeof(Eigen::Vector3f);
  part.m_vertexType = PHY_FLOAT;
  auto array = std::make_unique<btTriangleIndexVertexArray>();
  array->addIndexedMesh(part, PHY_INTEGER);
  return array;
}

}  // namespace

struct RigidBody::Impl {
  Impl(const WorldMesh& mesh, const Shape& shape, const Eigen::Vector3d& position,
       const Eigen::Quaterniond& turn)
      : vertices(mesh.vertices),
        indices(mesh.triangles),
        triangles(inPlace(vertices, indices)),
        configuration(smallPools()),
        dispatcher(&configuration),
        world(&dispatcher, &broadphase, &solver, &configuration),
        mesh_shape(triangles.get(), true),
        box_shape(toBullet(0.5 * shape.size_m)),
        ground(Construction(0.0, nullptr, &mesh_shape)),
        body(Construction(shape.mass_kg, nullptr, &box_shape, toBullet(shape.inertia_kgm2))) {
    // Bullet picks these rows by the processor it finds; the scalar ones are the same everywhere.
    solver.setConstraintRowSolverGeneric(solver.getScalarConstraintRowSolverGeneric());
    solver.setConstraintRowSolverLowerLimit(solver.getScalarConstraintRowSolverLowerLimit());
    world.getSolverInfo().m_solverMode &= ~SOLVER_SIMD;
    world.setForceUpdateAllAabbs(false);
    world.setGravity({0.0, 0.0, -kGravity});
    mesh_shape.setMargin(kMeshMargin);
    body.setWorldTransform(
        btTransform(btQuaternion(turn.x(), turn.y(), turn.z(), turn.w()), toBullet(position)));
    body.setInterpolationWorldTransform(body.getWorldTransform());
    body.setActivationState(DISABLE_DEACTIVATION);
    for (btRigidBody* part : {&ground, &body}) {
      part->setFriction(shape.friction);
      part->setRestitution(kRestitution);
      world.addRigidBody(part);
    }
  }
  ~Impl() {
    world.removeRigidBody(&body);
    world.removeRigidBody(&ground);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> indices;
  std::unique_ptr<btTriangleIndexVertexArray> triangles;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world;
  btBvhTriangleMeshShape mesh_shape;
  btBoxShape box_shape;
  btRigidBody ground;
  btRigidBody body;
  double last_step_s = 0.0;
};

RigidBody::RigidBody(const WorldMesh& mesh, const Shape& shape, const Eigen::Vector3d& position,
                     const Eigen::Quaterniond& orientation) {
  require(!mesh.triangles.empty(), "RigidBody: the mesh holds no triangles");
  require(shape.mass_kg > 0.0, "RigidBody: mass must be positive");
  impl_ = std::make_unique<Impl>(mesh, shape, position, orientation);
}
RigidBody::~RigidBody() = default;
RigidBody::RigidBody(RigidBody&&) noexcept = default;

void RigidBody::step(double step_s, const Wrench& wrench, const Eigen::Vector3d& outer_force_n) {
  btRigidBody& body = impl_->body;
  const btMatrix3x3& attitude = body.getWorldTransform().getBasis();
  body.applyCentralForce(attitude.getColumn(2) * wrench.thrust_n + toBullet(outer_force_n));
  body.applyTorque(attitude * toBullet(wrench.torque_nm));
  impl_->last_step_s = step_s;
  impl_->world.stepSimulation(step_s, 0);  // 0 sub-steps: exactly one step of this length
}

BodyState RigidBody::state() const {
  const btRigidBody& body = impl_->body;
  const btTransform& transform = body.getWorldTransform();
  const btQuaternion turn = transform.getRotation();
  BodyState state;
  state.position = toEigen(transform.getOrigin());
  state.orientation = Eigen::Quaterniond(turn.w(), turn.x(), turn.y(), turn.z()).normalized();
  state.velocity = toEigen(body.getLinearVelocity());
  state.angular_velocity = toEigen(transform.getBasis().transpose() * body.getAngularVelocity());
  return state;
}

bool RigidBody::isInContact() const {
  for (int m = 0; m < impl_->dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold* manifold = impl_->dispatcher.getManifoldByIndexInternal(m);
    for (int c = 0; c < manifold->getNumContacts(); ++c) {
      const btManifoldPoint& contact = manifold->getContactPoint(c);
      if (contact.getDistance() <= 0.0 || contact.getAppliedImpulse() > 0.0) return true;
    }
  }
  return false;
}

Eigen::Vector3d RigidBody::contactForce() const {
  btVector3 impulse(0.0, 0.0, 0.0);
  for (int m = 0; m < impl_->dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold* manifold = impl_->dispatcher.getManifoldByIndexInternal(m);
    const double sign = manifold->getBody0() == &impl_->body ? 1.0 : -1.0;
    for (int c = 0; c < manifold->getNumContacts(); ++c) {
      const btManifoldPoint& contact = manifold->getContactPoint(c);
      impulse += sign * contact.getAppliedImpulse() * contact.m_normalWorldOnB;
    }
  }
  return impl_->last_step_s > 0.0 ? Eigen::Vector3d(toEigen(impulse) / impl_->last_step_s)
                                  : Eigen::Vector3d::Zero();
}

}  // namespace spelunk::sim
