#include "spelunk/sim/rigid_body.h"

#include <gtest/gtest.h>

#include "support/meshes.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.0025;
const RigidBody::Shape kShape{2.0, {0.03, 0.03, 0.05}, {0.6, 0.6, 0.2}};

RigidBody bodyAt(const Vector3d& position) {
  return {test::boxRoom({20, 20, 10}), kShape, position, Eigen::Quaterniond::Identity()};
}

TEST(RigidBody, FallsWithGravity) {
  RigidBody body = bodyAt({0, 0, 8});
  for (int k = 0; k < 400; ++k) body.step(kStep, {}, Vector3d::Zero());
  EXPECT_NEAR(body.state().velocity.z(), -kGravity, 1e-9);
  EXPECT_NEAR(body.state().position.z(), 8.0 - 0.5 * kGravity, 0.02);  // Euler's steps
  EXPECT_FALSE(body.isInContact());
}

TEST(RigidBody, TorqueTurnsByItsInertia) {
  RigidBody body = bodyAt({0, 0, 5});
  const double weight = kShape.mass_kg * kGravity;
  for (int k = 0; k < 100; ++k) body.step(kStep, {weight, {0.0, 0.0, 0.02}}, Vector3d::Zero());
  EXPECT_NEAR(body.state().angular_velocity.z(), 0.25 * 0.02 / 0.05, 1e-6);
  EXPECT_NEAR(body.state().position.z(), 5.0, 1e-6);
}

TEST(RigidBody, RestsOnTheFloor) {
  RigidBody body = bodyAt({0.3, -0.2, 0.3});
  for (int k = 0; k < 800; ++k) body.step(kStep, {}, Vector3d::Zero());
  EXPECT_TRUE(body.isInContact());
  EXPECT_NEAR(body.state().position.z(), 0.1, 0.02);
  EXPECT_LT(body.state().velocity.norm(), 0.02);
}

TEST(RigidBody, WallStopsIt) {
  RigidBody body = bodyAt({9.0, 0, 5});
  const double weight = kShape.mass_kg * kGravity;
  bool has_touched = false;
  for (int k = 0; k < 800; ++k) {
    body.step(kStep, {weight, Vector3d::Zero()}, {6.0, 0.0, 0.0});
    has_touched = has_touched || body.isInContact();
    EXPECT_LT(body.state().position.x(), 9.8);
  }
  EXPECT_TRUE(has_touched);
}

TEST(RigidBody, TheFloorCarriesItsWeight) {
  RigidBody body = bodyAt({0.3, -0.2, 0.3});
  body.step(kStep, {}, Vector3d::Zero());
  EXPECT_EQ(body.contactForce().norm(), 0.0) << "it falls freely";
  for (int k = 0; k < 1200; ++k) body.step(kStep, {}, Vector3d::Zero());
  Vector3d mean = Vector3d::Zero();
  for (int k = 0; k < 400; ++k) {
    body.step(kStep, {}, Vector3d::Zero());
    mean += body.contactForce() / 400.0;
  }
  EXPECT_NEAR(mean.z(), kShape.mass_kg * kGravity, 0.5);
  EXPECT_LT(mean.head<2>().norm(), 0.5);
}

TEST(RigidBody, FrictionHoldsWhatSlidesWithoutIt) {
  const auto slideOf = [](double friction) {
    RigidBody::Shape shape = kShape;
    shape.friction = friction;
    RigidBody body(test::boxRoom({20, 20, 10}), shape, {0, 0, 0.12},
                   Eigen::Quaterniond::Identity());
    for (int k = 0; k < 400; ++k) body.step(kStep, {}, {4.0, 0.0, 0.0});
    return body.state().position.x();
  };
  EXPECT_LT(slideOf(0.7), 0.05);
  EXPECT_GT(slideOf(0.1), 0.5);
}

TEST(RigidBody, OuterForceAccelerates) {
  RigidBody body = bodyAt({0, 0, 5});
  const double weight = kShape.mass_kg * kGravity;
  for (int k = 0; k < 40; ++k) body.step(kStep, {weight, Vector3d::Zero()}, {1.0, 0.0, 0.0});
  EXPECT_NEAR(body.state().velocity.x(), 0.1 * 1.0 / 2.0, 1e-9);
}

}  // namespace
}  // namespace spelunk::sim
