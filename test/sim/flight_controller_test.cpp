#include "spelunk/sim/flight_controller.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

const Airframe kAirframe{2.0, {0.03, 0.03, 0.05}, 0.25, 45.0};

TrajectoryPoint hover() { return {}; }

TEST(FlightController, HoversAtWeight) {
  const Wrench wrench = computeWrench(kAirframe, {}, hover(), Vector3d::Zero());
  EXPECT_NEAR(wrench.thrust_n, 2.0 * kGravity, 1e-12);
  EXPECT_LT(wrench.torque_nm.norm(), 1e-12);
}

TEST(FlightController, PitchesDownToFlyForward) {
  TrajectoryPoint reference = hover();
  reference.pose.position.x() = 0.5;
  const Wrench wrench = computeWrench(kAirframe, {}, reference, Vector3d::Zero());
  EXPECT_GT(wrench.torque_nm.y(), 0.0);
  EXPECT_NEAR(wrench.torque_nm.x(), 0.0, 1e-12);
}

TEST(FlightController, TurnsTheShortWay) {
  BodyState state;
  state.orientation = Eigen::AngleAxisd(3.0, Vector3d::UnitZ());
  TrajectoryPoint reference = hover();
  reference.pose.yaw = -3.0;
  EXPECT_GT(computeWrench(kAirframe, state, reference, Vector3d::Zero()).torque_nm.z(), 0.0);
}

TEST(FlightController, RightsItselfFromUpsideDown) {
  for (const double roll : {3.1, -3.1}) {
    BodyState state;
    state.orientation = Eigen::AngleAxisd(roll, Vector3d::UnitX());
    const Wrench wrench = computeWrench(kAirframe, state, hover(), Vector3d::Zero());
    EXPECT_EQ(wrench.thrust_n, 0.0);
    EXPECT_GT(-roll * wrench.torque_nm.x(), 1.0);
  }
}

TEST(FlightController, FarReferenceAsksForBoundedTilt) {
  TrajectoryPoint near = hover();
  near.pose.position = {5.0, 0.0, 0.0};
  TrajectoryPoint far = hover();
  far.pose.position = {5000.0, 0.0, 0.0};
  const Wrench a = computeWrench(kAirframe, {}, near, Vector3d::Zero());
  const Wrench b = computeWrench(kAirframe, {}, far, Vector3d::Zero());
  EXPECT_TRUE(a.torque_nm.isApprox(b.torque_nm, 1e-9));
  EXPECT_GT(b.thrust_n, 0.3 * 2.0 * kGravity);
}

TEST(BrakingTrajectory, ComesToRestWithConstantDeceleration) {
  TrajectoryPoint from;
  from.pose.position = {1.0, 2.0, 3.0};
  from.velocity = {1.2, -1.6, 0.0};
  const Trajectory braking = brakingTrajectory(10.0, from, 2.5);
  EXPECT_TRUE(stateAt(braking, 10.0).velocity.isApprox(from.velocity, 1e-9));
  const TrajectoryPoint middle = stateAt(braking, 10.4);
  EXPECT_TRUE(middle.velocity.isApprox(0.5 * from.velocity, 1e-9));
  EXPECT_NEAR(middle.acceleration.norm(), 2.5, 1e-9);
  const TrajectoryPoint rest = stateAt(braking, 20.0);
  EXPECT_NEAR((rest.pose.position - from.pose.position).norm(), 0.5 * 2.0 * 2.0 / 2.5, 1e-9);
  EXPECT_EQ(rest.velocity, Vector3d::Zero());
}

TEST(BrakingTrajectory, HoldsARobotThatStands) {
  TrajectoryPoint from;
  from.pose = {{1.0, 2.0, 3.0}, 0.7};
  const TrajectoryPoint rest = stateAt(brakingTrajectory(0.0, from, 2.5), 5.0);
  EXPECT_EQ(rest.pose.position, from.pose.position);
  EXPECT_EQ(rest.pose.yaw, 0.7);
}

}  // namespace
}  // namespace spelunk::sim
