#include "spelunk/sim/rotors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

constexpr double kLong = 100.0;

class AnyRotorCount : public testing::TestWithParam<int> {};

TEST_P(AnyRotorCount, MakesTheWantedWrench) {
  Rotors rotors(GetParam(), 0.3, 0.05, 80.0);
  rotors.command({35.0, {0.8, -0.5, 0.1}});
  rotors.advance(kLong);
  EXPECT_NEAR(rotors.wrench().thrust_n, 35.0, 1e-9);
  EXPECT_TRUE(rotors.wrench().torque_nm.isApprox(Eigen::Vector3d(0.8, -0.5, 0.1), 1e-9))
      << rotors.wrench().torque_nm.transpose();
}

TEST_P(AnyRotorCount, StaysWithinTheLimitsOfEachRotor) {
  Rotors rotors(GetParam(), 0.3, 0.0, 80.0);
  for (const double thrust : {-50.0, 0.0, 40.0, 200.0})
    for (const double torque : {-60.0, 0.0, 3.0, 60.0}) {
      rotors.command({thrust, {torque, -0.3 * torque, 2.0 * torque}});
      rotors.advance(0.01);
      for (const double each : rotors.thrusts()) {
        EXPECT_GE(each, 0.0);
        EXPECT_LE(each, 80.0 / GetParam());
      }
    }
}

TEST_P(AnyRotorCount, GivesUpYawBeforeTilt) {
  Rotors rotors(GetParam(), 0.3, 0.0, 80.0);
  rotors.command({20.0, {1.0, 0.0, 50.0}});
  rotors.advance(0.01);
  EXPECT_NEAR(rotors.wrench().thrust_n, 20.0, 1e-9);
  EXPECT_NEAR(rotors.wrench().torque_nm.x(), 1.0, 1e-9);
  EXPECT_GT(rotors.wrench().torque_nm.z(), 0.0);
  EXPECT_LT(rotors.wrench().torque_nm.z(), 1.0);
}

TEST_P(AnyRotorCount, GivesUpThrustBeforeTilt) {
  Rotors rotors(GetParam(), 0.3, 0.0, 80.0);
  rotors.command({200.0, {1.5, -1.0, 0.0}});
  rotors.advance(0.01);
  EXPECT_NEAR(rotors.wrench().torque_nm.x(), 1.5, 1e-9);
  EXPECT_NEAR(rotors.wrench().torque_nm.y(), -1.0, 1e-9);
  EXPECT_LT(rotors.wrench().thrust_n, 80.0);
}

INSTANTIATE_TEST_SUITE_P(Rotors, AnyRotorCount, testing::Values(4, 6));

TEST(Rotors, FollowTheirCommandsWithALag) {
  Rotors rotors(4, 0.3, 0.05, 80.0);
  rotors.command({40.0, Eigen::Vector3d::Zero()});
  for (int k = 0; k < 50; ++k) rotors.advance(0.001);
  EXPECT_NEAR(rotors.wrench().thrust_n, 40.0 * (1.0 - std::exp(-1.0)), 1e-6);
}

TEST(Rotors, SpunUpTheyHover) {
  Rotors rotors(6, 0.3, 0.05, 80.0);
  rotors.spinUp(34.3);
  rotors.advance(1.0);
  EXPECT_NEAR(rotors.wrench().thrust_n, 34.3, 1e-12);
  EXPECT_LT(rotors.wrench().torque_nm.norm(), 1e-12);
}

TEST(Rotors, RefuseOtherCounts) { EXPECT_THROW(Rotors(5, 0.3, 0.05, 80.0), Precondition); }

}  // namespace
}  // namespace spelunk::sim
