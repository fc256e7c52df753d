#include "spelunk/navigation/trajectory_timing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::navigation {
namespace {

const MotionLimits kLimits{2.0, 2.0, 1.2, 3.0};
const MotionStart kRest{10.0, Eigen::Vector3d::Zero(), 0.0};

Path randomPath(Rng& rng, int waypoints) {
  Path path{{{0.0, 0.0, 1.0}, 0.0}};
  for (int k = 1; k < waypoints; ++k) {
    const Eigen::Vector3d step(rng.uniform(-3.0, 4.0), rng.uniform(-3.0, 3.0),
                               rng.uniform(-0.5, 0.5));
    path.push_back({path.back().position + step, 0.0});
  }
  return path;
}

/// Gentle bend: segments of 1 m that turn by 8 degrees each.
Path gentleCurve() {
  Path path{{{0.0, 0.0, 1.0}, 0.0}};
  double heading = 0.0;
  for (int k = 0; k < 40; ++k) {
    heading += 8.0 * M_PI / 180.0 * (k % 20 < 10 ? 1.0 : -1.0);
    path.push_back(
        {path.back().position + Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0),
         heading});
  }
  return path;
}

TEST(TrajectoryTiming, StraightLineTakesTheTrapezoidsTime) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{10.0, 0.0, 0.0}, 0.0}};
  // Up to 2 m/s and down again in 1 s and 1 m each, 8 m in between.
  EXPECT_NEAR(travelTime(path, kLimits), 6.0, 0.01);
  const Trajectory trajectory = timed(path, kLimits, kRest);
  EXPECT_DOUBLE_EQ(trajectory.front().time_s, 10.0);
  EXPECT_NEAR(trajectory.back().time_s, 16.0, 0.01);
  EXPECT_NEAR(trajectory.back().pose.position.x(), 10.0, 1e-9);
  EXPECT_EQ(trajectory.back().velocity.norm(), 0.0);
}

TEST(TrajectoryTiming, TravelTimeIsTheLastTimeOfTheTrajectory) {
  Rng rng(1);
  for (int k = 0; k < 50; ++k) {
    const Path path = randomPath(rng, 2 + k % 12);
    const Trajectory trajectory = timed(path, kLimits, {0.0, Eigen::Vector3d::Zero(), 0.0});
    EXPECT_NEAR(travelTime(path, kLimits), trajectory.back().time_s, 1e-9);
  }
}

TEST(TrajectoryTiming, StaysWithinSpeedAccelerationAndCornerTolerance) {
  Rng rng(2);
  for (int k = 0; k < 50; ++k) {
    const Path path = randomPath(rng, 3 + k % 8);
    const double tolerance = k % 2 == 0 ? 0.1 : 0.4;
    const Trajectory trajectory = timed(path, kLimits, kRest, tolerance);
    for (double t = 10.0; t < trajectory.back().time_s; t += 0.02) {
      const TrajectoryPoint point = stateAt(trajectory, t);
      EXPECT_LE(project(path, point.pose.position).distance_m, tolerance + 0.03);
      EXPECT_LE(point.velocity.norm(), kLimits.speed_mps + 0.15);
    }
    for (const TrajectoryPoint& point : trajectory)
      EXPECT_LE(point.acceleration.norm(), kLimits.acceleration_mps2 * 1.1);  // discrete curve
  }
}

TEST(TrajectoryTiming, VelocityIsTheRateOfPosition) {
  Rng rng(3);
  const Trajectory trajectory = timed(randomPath(rng, 10), kLimits, kRest);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double step = trajectory[i].time_s - trajectory[i - 1].time_s;
    ASSERT_GT(step, 0.0);
    EXPECT_LE(step, 0.13);
    const Eigen::Vector3d mean =
        (trajectory[i].pose.position - trajectory[i - 1].pose.position) / step;
    const Eigen::Vector3d expected = 0.5 * (trajectory[i].velocity + trajectory[i - 1].velocity);
    EXPECT_LT((mean - expected).norm(), 0.12);
  }
}

TEST(TrajectoryTiming, GentleCurveIsFlownAtFullSpeed) {
  const Path path = gentleCurve();
  EXPECT_GT(lengthOf(path) / travelTime(path, kLimits), 1.85);
}

TEST(TrajectoryTiming, LargerToleranceMakesCornersFaster) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{5.0, 0.0, 0.0}, 0.0}, {{5.0, 5.0, 0.0}, 0.0}};
  const double tight = timed(path, kLimits, kRest, 0.05).back().time_s;
  const double wide = timed(path, kLimits, kRest, 0.6).back().time_s;
  EXPECT_LT(wide, tight - 0.5);
}

TEST(TrajectoryTiming, TakesUpVelocityAlongThePath) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{10.0, 0.0, 0.0}, 0.0}};
  const Trajectory trajectory = timed(path, kLimits, {0.0, {2.0, 0.0, 0.0}, 0.0});
  EXPECT_NEAR(trajectory.front().velocity.x(), 2.0, 1e-9);
  EXPECT_NEAR(trajectory.back().time_s, 5.5, 0.02);
}

TEST(TrajectoryTiming, BlendsVelocityAcrossThePathWithoutAJump) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{10.0, 0.0, 0.0}, 0.0}};
  const Eigen::Vector3d velocity(0.5, 1.0, -0.2);
  const Trajectory trajectory = timed(path, kLimits, {0.0, velocity, 0.0});
  EXPECT_LT((trajectory.front().velocity - velocity).norm(), 1e-9);
  EXPECT_EQ(trajectory.front().pose.position, path.front().position);
  double widest = 0.0;
  for (const TrajectoryPoint& point : trajectory)
    widest = std::max(widest, project(path, point.pose.position).distance_m);
  EXPECT_LT(widest, 0.4);
  EXPECT_LT((trajectory.back().pose.position - path.back().position).norm(), 1e-9);
}

TEST(TrajectoryTiming, TooFastForTheFirstCornerStillEndsOnThePath) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{0.3, 0.0, 0.0}, 0.0}};
  const Trajectory trajectory = timed(path, kLimits, {0.0, {2.0, 0.0, 0.0}, 0.0});
  EXPECT_LT((trajectory.front().velocity - Eigen::Vector3d(2.0, 0.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((trajectory.back().pose.position - path.back().position).norm(), 1e-9);
  EXPECT_EQ(trajectory.back().velocity.norm(), 0.0);
}

TEST(TrajectoryTiming, TurnsBackOnTheSpotAtRest) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{4.0, 0.0, 0.0}, 0.0}, {{0.0, 0.0, 0.0}, 0.0}};
  const Trajectory trajectory = timed(path, kLimits, kRest);
  EXPECT_NEAR(trajectory.back().time_s - 10.0, 6.0, 0.05);
  double farthest = 0.0;
  for (const TrajectoryPoint& point : trajectory)
    farthest = std::max(farthest, point.pose.position.x());
  EXPECT_NEAR(farthest, 4.0, 0.05);
}

TEST(TrajectoryTiming, HeadingFollowsWithinRateAndAcceleration) {
  Rng rng(4);
  for (int k = 0; k < 20; ++k) {
    const Trajectory trajectory = timed(randomPath(rng, 8), kLimits, kRest);
    for (std::size_t i = 1; i < trajectory.size(); ++i) {
      const double step = trajectory[i].time_s - trajectory[i - 1].time_s;
      EXPECT_LE(std::abs(trajectory[i].yaw_rate), kLimits.yaw_rate_radps + 1e-9);
      EXPECT_LE(std::abs(trajectory[i].yaw_rate - trajectory[i - 1].yaw_rate),
                kLimits.yaw_acceleration_radps2 * step + 1e-6);
    }
  }
}

TEST(TrajectoryTiming, LongStraightEndsLookingForward) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{0.0, 12.0, 0.0}, 0.0}};
  const Trajectory trajectory = timed(path, kLimits, kRest);
  EXPECT_NEAR(trajectory[trajectory.size() / 2].pose.yaw, M_PI / 2.0, 0.05);
}

TEST(TrajectoryTiming, TurnWithoutMotionTurns) {
  const Path path{{{1.0, 2.0, 3.0}, 0.0}, {{1.0, 2.0, 3.0}, 2.5}};
  const Trajectory trajectory = timed(path, kLimits, kRest);
  EXPECT_NEAR(trajectory.back().pose.yaw, 2.5, 0.05);
  EXPECT_EQ(trajectory.back().pose.position, path.front().position);
  EXPECT_GT(travelTime(path, kLimits), 2.0);
}

TEST(TrajectoryTiming, OnePoseIsHeld) {
  const Trajectory trajectory = timed({{{1.0, 2.0, 3.0}, 0.3}}, kLimits, kRest);
  ASSERT_FALSE(trajectory.empty());
  EXPECT_EQ(trajectory.front().velocity.norm(), 0.0);
  EXPECT_DOUBLE_EQ(travelTime({{{1.0, 2.0, 3.0}, 0.3}}, kLimits), 0.0);
}

TEST(TrajectoryTiming, EmptyPathBreaksTheContract) {
  EXPECT_THROW(static_cast<void>(timed({}, kLimits, kRest)), Precondition);
  EXPECT_THROW(static_cast<void>(travelTime({}, kLimits)), Precondition);
}

}  // namespace
}  // namespace spelunk::navigation
