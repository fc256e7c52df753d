#include "spelunk/sim/force_distribution.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kFriction = 0.6;
constexpr double kStrength = 450.0;

std::vector<FootContact> fourFeet() {
  return {{{0.3, 0.24, -0.5}, Vector3d::UnitZ()},
          {{0.3, -0.24, -0.5}, Vector3d::UnitZ()},
          {{-0.3, 0.24, -0.5}, Vector3d::UnitZ()},
          {{-0.3, -0.24, -0.5}, Vector3d::UnitZ()}};
}

TrunkWrench wrenchOf(const std::vector<FootContact>& contacts,
                     const std::vector<Vector3d>& forces) {
  TrunkWrench wrench;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    wrench.force_n += forces[k];
    wrench.torque_nm += contacts[k].lever.cross(forces[k]);
  }
  return wrench;
}

/// What the distribution minimises over the pyramids' edges, found the slow way: coordinate by
/// coordinate, over and over.
class SlowSolver {
 public:
  SlowSolver(const TrunkWrench& wanted, const std::vector<FootContact>& contacts) {
    for (const FootContact& contact : contacts) {
      const Vector3d aside =
          std::abs(contact.normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
      const Vector3d first = contact.normal.cross(aside).normalized();
      for (const Vector3d& tangent : {first, Vector3d(contact.normal.cross(first))})
        for (const double side : {1.0, -1.0}) {
          Eigen::Matrix<double, 6, 1> edge;
          const Vector3d force = contact.normal + side * kFriction * tangent;
          edge << force, std::sqrt(10.0) * contact.lever.cross(force);
          edges_.push_back(edge);
        }
    }
    rest_ << wanted.force_n, std::sqrt(10.0) * wanted.torque_nm;
    factors_.assign(edges_.size(), 0.0);
  }

  void sweep() {
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      const double slope = edges_[k].dot(rest_) - 0.02 * factors_[k];
      const double curvature = edges_[k].squaredNorm() + 0.02;
      const double next = std::clamp(factors_[k] + slope / curvature, 0.0, 0.5 * kStrength);
      rest_ -= (next - factors_[k]) * edges_[k];
      factors_[k] = next;
    }
  }

  [[nodiscard]] Vector3d force(std::size_t foot) const {
    Vector3d force = Vector3d::Zero();
    for (std::size_t k = 4 * foot; k < 4 * foot + 4; ++k)
      force += factors_[k] * edges_[k].head<3>();
    return force;
  }

 private:
  std::vector<Eigen::Matrix<double, 6, 1>> edges_;
  Eigen::Matrix<double, 6, 1> rest_;
  std::vector<double> factors_;
};

TEST(ForceDistribution, AgreesWithCoordinateDescent) {
  Rng rng(3);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<FootContact> contacts = fourFeet();
    contacts.resize(static_cast<std::size_t>(1 + rng.below(4)));
    for (FootContact& contact : contacts) {
      contact.lever += 0.1 * Vector3d(rng.normal(), rng.normal(), rng.normal());
      contact.normal = Vector3d(0.3 * rng.normal(), 0.3 * rng.normal(), 1.0).normalized();
    }
    const TrunkWrench wanted{
        {100.0 * rng.normal(), 100.0 * rng.normal(), 300.0 + 100.0 * rng.normal()},
        {40.0 * rng.normal(), 40.0 * rng.normal(), 20.0 * rng.normal()}};
    const auto fast = distributeForces(wanted, contacts, kFriction, kStrength);
    SlowSolver slow(wanted, contacts);
    for (int k = 0; k < 20000; ++k) slow.sweep();
    for (std::size_t foot = 0; foot < contacts.size(); ++foot)
      EXPECT_LT((fast[foot] - slow.force(foot)).norm(), 0.05) << "trial " << trial;
  }
}

TEST(ForceDistribution, CarriesTheWeightEvenly) {
  const TrunkWrench weight{{0, 0, 294.3}, {0, 0, 0}};
  const auto forces = distributeForces(weight, fourFeet(), kFriction, kStrength);
  ASSERT_EQ(forces.size(), 4U);
  for (const Vector3d& force : forces) {
    EXPECT_NEAR(force.z(), 294.3 / 4.0, 0.5);
    EXPECT_LT(force.head<2>().norm(), 0.1);
  }
}

TEST(ForceDistribution, GivesAFeasibleWrench) {
  const TrunkWrench wanted{{30, -20, 320}, {15, -25, 8}};
  const TrunkWrench given =
      wrenchOf(fourFeet(), distributeForces(wanted, fourFeet(), kFriction, kStrength));
  EXPECT_LT((given.force_n - wanted.force_n).norm(), 2.0);
  EXPECT_LT((given.torque_nm - wanted.torque_nm).norm(), 1.0);
}

TEST(ForceDistribution, NeverPullsNorLeavesTheConeNorExceedsTheStrength) {
  Rng rng(5);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<FootContact> contacts = fourFeet();
    for (FootContact& contact : contacts)
      contact.normal = Vector3d(0.4 * rng.normal(), 0.4 * rng.normal(), 1.0).normalized();
    const TrunkWrench wanted{{500.0 * rng.normal(), 500.0 * rng.normal(), 800.0 * rng.normal()},
                             {200.0 * rng.normal(), 200.0 * rng.normal(), 200.0 * rng.normal()}};
    const auto forces = distributeForces(wanted, contacts, kFriction, kStrength);
    for (std::size_t k = 0; k < 4; ++k) {
      const double pressure = forces[k].dot(contacts[k].normal);
      EXPECT_GE(pressure, -1e-9);
      EXPECT_LE((forces[k] - pressure * contacts[k].normal).norm(), kFriction * pressure + 1e-6);
      EXPECT_LE(pressure, 2.0 * kStrength + 1e-6);
    }
  }
}

TEST(ForceDistribution, WithoutFeetThereIsNoForce) {
  EXPECT_TRUE(distributeForces({{0, 0, 100}, {0, 0, 0}}, {}, kFriction, kStrength).empty());
  const std::vector<FootContact> five(5);
  EXPECT_THROW((void)distributeForces({}, five, kFriction, kStrength), Precondition);
}

}  // namespace
}  // namespace spelunk::sim
