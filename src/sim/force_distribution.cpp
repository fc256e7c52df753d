#include "spelunk/sim/force_distribution.h"

#include <BulletDynamics/MLCPSolvers/btDantzigLCP.h>

#include <Eigen/Geometry>
#include <array>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr int kEdges = 4;  ///< Of a friction pyramid.
constexpr int kContactsMax = 4;
constexpr int kSizeMax = kEdges * kContactsMax;
constexpr double kTorqueWeight = 10.0;  ///< 1/m^2: a newton at 0.3 m counts as a newton.
constexpr double kForceWeight = 0.02;   ///< Of the forces against the error of the wrench.

using Edges = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kSizeMax>;
using Square =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kSizeMax, kSizeMax>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSizeMax, 1>;

/// Any two directions along the ground.
std::array<Vector3d, 2> tangents(const Vector3d& normal) {
  const Vector3d aside = std::abs(normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d first = normal.cross(aside).normalized();
  return {first, normal.cross(first)};
}

/// Force and torque of each edge, one a column.
Edges edgesOf(const std::vector<FootContact>& contacts, double friction) {
  Edges edges(6, kEdges * static_cast<int>(contacts.size()));
  int column = 0;
  for (const FootContact& contact : contacts) {
    for (const Vector3d& tangent : tangents(contact.normal)) {
      for (const double side : {1.0, -1.0}) {
        const Vector3d force = contact.normal + side * friction * tangent;
        edges.col(column).head<3>() = force;
        edges.col(column).tail<3>() = contact.lever.cross(force);
        ++column;
      }
    }
  }
  return edges;
}

/// Minimises x' H x / 2 - g' x over 0 <= x <= limit.
Column minimise(Square hessian, Column gradient, double limit) {
  const auto size = static_cast<int>(gradient.size());
  Column factors = Column::Zero(size);
  Column slack = Column::Zero(size);
  Column low = Column::Zero(size);
  Column high = Column::Constant(size, limit);
  // The solver takes x[findex] as a friction bound; -1 means an ordinary row.
  std::array<int, kSizeMax> ordinary{};
  ordinary.fill(-1);
  btDantzigScratchMemory scratch;
  const bool is_solved =
      btSolveDantzigLCP(size, hessian.data(), factors.data(), gradient.data(), slack.data(), 0,
                        low.data(), high.data(), ordinary.data(), scratch);
  return is_solved ? factors : Column::Zero(size);
}

}  // namespace

std::vector<Vector3d> distributeForces(const TrunkWrench& wanted,
                                       const std::vector<FootContact>& contacts, double friction,
                                       double force_max_n) {
  require(contacts.size() <= kContactsMax, "distributeForces: more than four feet");
  if (contacts.empty()) return {};
  const Edges edges = edgesOf(contacts, friction);
  Eigen::Matrix<double, 6, 1> target;
  target << wanted.force_n, wanted.torque_nm;
  Eigen::Matrix<double, 6, 1> weights;
  weights << 1.0, 1.0, 1.0, kTorqueWeight, kTorqueWeight, kTorqueWeight;
  const Edges weighted = weights.asDiagonal() * edges;
  Square hessian = edges.transpose().lazyProduct(weighted);
  hessian.diagonal().array() += kForceWeight;
  const Column gradient = weighted.transpose().lazyProduct(target);
  const Column factors = minimise(hessian, gradient, 0.5 * force_max_n);
  std::vector<Vector3d> forces;
  for (int foot = 0; foot < static_cast<int>(contacts.size()); ++foot)
    forces.emplace_back(edges.block<3, kEdges>(0, kEdges * foot) *
                        factors.segment<kEdges>(kEdges * foot));
  return forces;
}

}  // namespace spelunk::sim
