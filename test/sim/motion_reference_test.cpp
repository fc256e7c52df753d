#include "spelunk/sim/motion_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/sim/walk_tracker.h"
#include "support/walking.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

BodyState bodyAt(const Vector3d& position, double yaw) {
  BodyState body;
  body.position = position;
  body.orientation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ());
  return body;
}

TEST(MotionReference, HoldsTheStartUntilTold) {
  const MotionReference reference({{1, 2, 3}, 0.5}, 1.0);
  const TrajectoryPoint point = reference.at(17.0, bodyAt({9, 9, 9}, 0.0));
  EXPECT_EQ(point.pose.position, Vector3d(1, 2, 3));
  EXPECT_EQ(point.pose.yaw, 0.5);
  EXPECT_EQ(point.velocity.norm(), 0.0);
}

TEST(MotionReference, HoldingBackMovesTheRestOfATrajectory) {
  MotionReference reference({}, 1.0);
  const Trajectory trajectory = test::walkAlong({{0, 0}, {4, 0}}, 0.5, 0.0);
  const BodyState body = bodyAt({0, 0, 0}, 0.0);
  reference.follow(trajectory, 0.0, body);
  const Vector3d before = reference.at(3.0, body).pose.position;
  reference.holdBack(1.5);
  EXPECT_LT((reference.at(4.5, body).pose.position - before).norm(), 1e-12);
  reference.follow(trajectory, 4.5, body);
  EXPECT_LT((reference.at(3.0, body).pose.position - before).norm(), 1e-12);
}

TEST(MotionReference, DriveTurnsWithTheRobotAndLapses) {
  MotionReference reference({}, 1.0);
  BodyState body = bodyAt({1, 1, 0}, M_PI / 2);
  body.velocity = {0, 0.5, 0};
  reference.drive({0.5, 0.2, 0.1}, 10.0);
  reference.update(10.0 + kDriveTimeout, body);
  const TrajectoryPoint driven = reference.at(10.5, body);
  EXPECT_LT((driven.velocity - Vector3d(-0.2, 0.5, 0.0)).norm(), 1e-12);
  EXPECT_EQ(driven.yaw_rate, 0.1);
  EXPECT_EQ(driven.pose.position, body.position);
  reference.update(10.0 + kDriveTimeout + 0.01, body);
  const TrajectoryPoint stopped = reference.at(20.0, bodyAt({5, 5, 0}, 0.0));
  EXPECT_EQ(stopped.velocity.norm(), 0.0);
  EXPECT_LT((stopped.pose.position - Vector3d(1.0, 1.125, 0.0)).norm(), 1e-9) << "v^2 / 2a ahead";
}

TEST(MotionReference, ClampsEachPartToItsOwnLimit) {
  const DriveLimits limits{0.5, 0.3, 0.2, 0.6};
  const DriveCommand inside = clamped({0.4, -0.1, 0.5}, limits);
  EXPECT_EQ(inside.forward_mps, 0.4);
  EXPECT_EQ(inside.sideways_mps, -0.1);
  EXPECT_EQ(inside.yaw_rate_radps, 0.5);
  const DriveCommand outside = clamped({-0.4, -0.3, -0.7}, limits);
  EXPECT_EQ(outside.forward_mps, -0.3);
  EXPECT_EQ(outside.sideways_mps, -0.2);
  EXPECT_EQ(outside.yaw_rate_radps, -0.6);
}

TEST(WalkTracker, AcceleratesWithinTheLimitsAndNeverExceedsThem) {
  const RobotModel robot = test::walkerModel(0.5);
  WalkTracker tracker(robot, {});
  MotionReference reference({}, 1.0);
  TrajectoryPoint far;
  far.pose = {{30, 30, 0}, 3.0};
  const BodyState body = bodyAt({0, 0, 0}, 0.3);
  reference.follow({far}, 0.0, body);
  DriveCommand last;
  for (int k = 0; k < 500; ++k) {
    const DriveCommand now = tracker.advance(0.01, 0.01 * k, body, reference);
    EXPECT_LE(std::abs(now.forward_mps - last.forward_mps),
              0.01 * robot.acceleration_max_mps2 + 1e-12);
    EXPECT_LE(std::abs(now.yaw_rate_radps - last.yaw_rate_radps),
              0.01 * robot.yaw_acceleration_max_radps2 + 1e-12);
    EXPECT_LE(std::abs(now.sideways_mps), 0.4 * 0.5 * 1.2 + 1e-12);
    last = now;
  }
  EXPECT_NEAR(last.yaw_rate_radps, robot.yaw_rate_max_radps, 1e-9);
  const double to_goal = std::atan2(30.0, 30.0) - 0.3;
  EXPECT_NEAR(std::atan2(last.sideways_mps, last.forward_mps), to_goal, 1e-6)
      << "the direction suffers from the limits";
}

TEST(WalkTracker, RestsNearItsGoalAndWakesFarther) {
  WalkTracker tracker(test::walkerModel(), {});
  MotionReference reference({{0, 0, 0.5}, 0.0}, 1.0);
  const auto speedAt = [&](double x) {
    double speed = 0.0;
    for (int k = 0; k < 100; ++k)
      speed = tracker.advance(0.01, 0.01 * k, bodyAt({x, 0, 0.5}, 0.0), reference).forward_mps;
    return speed;
  };
  EXPECT_EQ(speedAt(0.08), 0.0);
  EXPECT_LT(speedAt(0.11), 0.0);
  EXPECT_LT(speedAt(0.05), 0.0);
  EXPECT_EQ(speedAt(0.03), 0.0);
}

}  // namespace
}  // namespace spelunk::sim
