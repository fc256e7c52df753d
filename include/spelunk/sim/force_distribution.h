#pragma once

#include <Eigen/Core>
#include <vector>

namespace spelunk::sim {

/// A foot on the ground.
struct FootContact {
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();    ///< From the trunk's centre, world frame, m.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Of the ground, unit.
};

/// What the feet together are to do to the trunk, world frame.
struct TrunkWrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();
};

/// The forces of the ground on the feet, one a contact, that come nearest to `wanted`: the least
/// squares of the error of the wrench and, with a small weight, of the forces themselves, over
/// forces within friction pyramids (inscribed in the cones of `friction`) that only push. A
/// pyramid's edges are limited so that a foot along its normal pushes at most `force_max_n`.
///
/// With each force as a sum of its pyramid's edges times factors from 0 up, this is a quadratic
/// programme with bounds only; its conditions of optimality are a boxed linear complementarity
/// problem, which Bullet's Dantzig solver solves exactly, by pivoting.
[[nodiscard]] std::vector<Eigen::Vector3d> distributeForces(
    const TrunkWrench& wanted, const std::vector<FootContact>& contacts, double friction,
    double force_max_n);

}  // namespace spelunk::sim
