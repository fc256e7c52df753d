#include "spelunk/common/path.h"

#include <gtest/gtest.h>

#include "spelunk/common/contract.h"
#include "spelunk/common/trajectory.h"

namespace spelunk {
namespace {

Path corner() { return {{{0, 0, 0}, 0.0}, {{4, 0, 0}, 0.0}, {{4, 3, 0}, 1.0}}; }

TEST(Path, LengthIsTheSumOfItsSegments) {
  EXPECT_DOUBLE_EQ(lengthOf(corner()), 7.0);
  EXPECT_DOUBLE_EQ(lengthOf({}), 0.0);
}

TEST(Path, PoseAtInterpolatesAndClamps) {
  EXPECT_TRUE(poseAt(corner(), 5.5).position.isApprox(Eigen::Vector3d(4, 1.5, 0)));
  EXPECT_NEAR(poseAt(corner(), 5.5).yaw, 0.5, 1e-12);
  EXPECT_TRUE(poseAt(corner(), 99.0).position.isApprox(Eigen::Vector3d(4, 3, 0)));
  EXPECT_THROW(poseAt({}, 0.0), Precondition);
}

TEST(Path, SliceKeepsTheCornersBetweenItsEnds) {
  const Path part = slice(corner(), 3.0, 6.0);
  ASSERT_EQ(part.size(), 3u);
  EXPECT_TRUE(part[1].position.isApprox(Eigen::Vector3d(4, 0, 0)));
  EXPECT_DOUBLE_EQ(lengthOf(part), 3.0);
  EXPECT_EQ(slice(corner(), 2.0, 2.0).size(), 1u);
}

TEST(Path, ResamplingKeepsTheLineAndItsWaypoints) {
  const Path dense = resampled(corner(), 0.9);
  EXPECT_NEAR(lengthOf(dense), 7.0, 1e-12);
  for (std::size_t i = 1; i < dense.size(); ++i) EXPECT_LE(distance(dense[i - 1], dense[i]), 0.9);
  EXPECT_NEAR(project(dense, {4, 0, 0}).distance_m, 0.0, 1e-12);
}

TEST(Path, ProjectionFindsTheNearestPointOfTheLine) {
  const PathProjection nearest = project(corner(), {5.0, 1.0, 0.0});
  EXPECT_NEAR(nearest.arc_m, 5.0, 1e-12);
  EXPECT_NEAR(nearest.distance_m, 1.0, 1e-12);
}

TEST(Pose, WrapKeepsPiAndTurnsMinusPiRound) {
  EXPECT_DOUBLE_EQ(wrapAngle(M_PI), M_PI);
  EXPECT_DOUBLE_EQ(wrapAngle(-M_PI), M_PI);
  EXPECT_NEAR(wrapAngle(7.0), 7.0 - 2 * M_PI, 1e-12);
}

TEST(Trajectory, HermiteMeetsPositionsAndVelocitiesOfItsPoints) {
  Trajectory motion(2);
  motion[0].velocity = {1, 0, 0};
  motion[1].time_s = 2.0;
  motion[1].pose = {{2, 1, 0}, 0.4};
  motion[1].velocity = {0, 1, 0};
  EXPECT_TRUE(stateAt(motion, 0.0).velocity.isApprox(Eigen::Vector3d(1, 0, 0)));
  const TrajectoryPoint late = stateAt(motion, 2.0 - 1e-9);
  EXPECT_LT((late.velocity - Eigen::Vector3d(0, 1, 0)).norm(), 1e-6);
  EXPECT_LT((late.pose.position - Eigen::Vector3d(2, 1, 0)).norm(), 1e-6);
  const TrajectoryPoint after = stateAt(motion, 3.0);
  EXPECT_EQ(after.velocity.norm(), 0.0);
  const TrajectoryPoint before = stateAt(motion, 1.0 - 1e-6);
  const TrajectoryPoint behind = stateAt(motion, 1.0 + 1e-6);
  const Eigen::Vector3d slope = (behind.pose.position - before.pose.position) / 2e-6;
  EXPECT_LT((slope - stateAt(motion, 1.0).velocity).norm(), 1e-5);
}

}  // namespace
}  // namespace spelunk
