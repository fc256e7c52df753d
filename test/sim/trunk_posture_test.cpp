#include "spelunk/sim/trunk_posture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spelunk::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

FootPoints feetOn(double slope_x, double slope_y) {
  FootPoints feet{{{0.3, 0.24, 0}, {0.3, -0.24, 0}, {-0.3, 0.24, 0}, {-0.3, -0.24, 0}}};
  for (Vector3d& foot : feet) foot.z() = slope_x * foot.x() + slope_y * foot.y() + 1.0;
  return feet;
}

BodyState standing(double z) {
  BodyState body;
  body.position = {0, 0, z};
  return body;
}

TEST(TrunkPosture, FindsThePlaneOfTheFeet) {
  const GroundPlane plane = planeThrough(feetOn(0.3, -0.1));
  EXPECT_NEAR(plane.slope.x(), 0.3, 1e-3);
  EXPECT_NEAR(plane.slope.y(), -0.1, 1e-3);
  EXPECT_NEAR(plane.heightAt(Vector2d(0.2, 0.1)), 1.0 + 0.06 - 0.01, 1e-3);
  EXPECT_LT((plane.normal() - Vector3d(-0.3, 0.1, 1.0).normalized()).norm(), 1e-3);
}

TEST(TrunkPosture, OrientationLiesOnThePlaneAndKeepsItsHeading) {
  const Vector3d normal = Vector3d(-0.3, 0.1, 1.0).normalized();
  const Eigen::Quaterniond turn = orientationOn(normal, 0.7);
  EXPECT_LT((turn * Vector3d::UnitZ() - normal).norm(), 1e-12);
  const Vector3d ahead = turn * Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), 0.7, 0.05);
  EXPECT_NEAR(turn.toRotationMatrix().determinant(), 1.0, 1e-12);
}

TEST(TrunkPosture, AtRestItAsksForTheWeight) {
  const WalkerParams params;
  TrunkPosture posture(params, standing(1.5), feetOn(0.0, 0.0));
  posture.advance(0.01, standing(1.5), {}, feetOn(0.0, 0.0));
  const TrunkWrench wrench = posture.wrench(standing(1.5));
  EXPECT_LT((wrench.force_n - Vector3d(0, 0, params.trunk_mass_kg * kGravity)).norm(), 1e-9);
  EXPECT_LT(wrench.torque_nm.norm(), 1e-9);
}

TEST(TrunkPosture, PushesBackAgainstADisturbance) {
  const WalkerParams params;
  TrunkPosture posture(params, standing(1.5), feetOn(0.0, 0.0));
  BodyState pushed = standing(1.45);
  pushed.velocity = {0.2, 0, 0};
  pushed.orientation = Eigen::AngleAxisd(0.1, Vector3d::UnitY());
  posture.advance(0.01, pushed, {}, feetOn(0.0, 0.0));
  const TrunkWrench wrench = posture.wrench(pushed);
  EXPECT_GT(wrench.force_n.z(), params.trunk_mass_kg * kGravity);
  EXPECT_LT(wrench.force_n.x(), 0.0);
  EXPECT_LT(wrench.torque_nm.y(), 0.0) << "nose down is lifted";
}

TEST(TrunkPosture, LowersItselfForALowFoot) {
  const WalkerParams params;
  FootPoints feet = feetOn(0.0, 0.0);
  TrunkPosture posture(params, standing(1.5), feet);
  feet[0].z() -= 0.2;
  for (int k = 0; k < 100; ++k) posture.advance(0.01, standing(1.5), {}, feet);
  EXPECT_LT(posture.wrench(standing(1.5)).force_n.z(), 0.8 * params.trunk_mass_kg * kGravity);
}

double liftOn(const FootPoints& feet) {
  TrunkPosture posture(WalkerParams{}, standing(1.5), feet);
  for (int k = 0; k < 100; ++k) posture.advance(0.01, standing(1.5), {}, feet);
  return posture.wrench(standing(1.5)).force_n.z();
}

TEST(TrunkPosture, StandsLowerOnUnevenGroundNotOnASlope) {
  FootPoints across = feetOn(0.0, 0.0);  // two feet on blocks, one diagonal
  across[0].z() += 0.06;
  across[3].z() += 0.06;
  for (Vector3d& foot : across) foot.z() -= 0.03;  // the same plane as on the flat
  EXPECT_LT(liftOn(across), liftOn(feetOn(0.0, 0.0)) - 20.0);
  EXPECT_NEAR(liftOn(feetOn(0.2, 0.1)), liftOn(feetOn(0.0, 0.0)), 1.0);
}

TEST(TrunkPosture, StoopsWhileAFootHasNoPlaceAndRisesAgain) {
  const FootPoints feet = feetOn(0.0, 0.0);
  TrunkPosture posture(WalkerParams{}, standing(1.5), feet);
  const auto liftAfter = [&](int steps, Footing footing) {
    for (int k = 0; k < steps; ++k) posture.advance(0.01, standing(1.5), {}, feet, footing);
    return posture.wrench(standing(1.5)).force_n.z();
  };
  const double weight = WalkerParams{}.trunk_mass_kg * kGravity;
  EXPECT_LT(liftAfter(50, Footing::kWanting), weight - 100.0);
  EXPECT_NEAR(liftAfter(200, Footing::kComplete), weight, 1.0);
}

TEST(TrunkPosture, FollowsTheGroundWithinALag) {
  TrunkPosture posture(WalkerParams{}, standing(1.5), feetOn(0.0, 0.0));
  posture.advance(0.01, standing(1.5), {}, feetOn(0.3, 0.0));
  EXPECT_LT(posture.ground().slope.x(), 0.05);
  for (int k = 0; k < 100; ++k) posture.advance(0.01, standing(1.5), {}, feetOn(0.3, 0.0));
  EXPECT_NEAR(posture.ground().slope.x(), 0.3, 0.01);
}

}  // namespace
}  // namespace spelunk::sim
