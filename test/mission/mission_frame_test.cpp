#include "spelunk/mission/mission_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spelunk::mission {
namespace {

constexpr double kResolution_m = 0.2;
constexpr double kStep_s = 0.1;
constexpr double kDegree = M_PI / 180.0;
const Eigen::Vector3d kVelocity(1.0, 0.0, 0.0);

/// A robot that flies along x at 1 m/s, as somebody's SLAM reports it: `slam` takes the robot's own
/// frame to the one that is reported.
RobotState reportAt(double time_s, const Shift& slam) {
  RobotState state;
  state.stamp_s = time_s;
  state.pose.position = kVelocity * time_s;
  state.velocity = kVelocity;
  return moved(state, slam);
}

/// Flies up to `time_s` without any correction.
MissionFrame flownTo(double time_s) {
  MissionFrame frame(RobotModel(), kResolution_m);
  const int steps = static_cast<int>(std::lround(time_s / kStep_s));
  for (int k = 0; k <= steps; ++k) EXPECT_FALSE(frame.take(reportAt(k * kStep_s, Shift())));
  return frame;
}

TEST(MissionFrame, LeavesMotionAlone) { EXPECT_TRUE(flownTo(40.0).now().isCallers()); }

TEST(MissionFrame, TakesALoopClosureAsACorrectionOfTheFrame) {
  MissionFrame frame = flownTo(43.0);
  const Shift slam(Eigen::Vector3d(1.5, 1.0, 0.1), 3.0 * kDegree);
  const RobotState report = reportAt(43.1, slam);
  const auto said = frame.take(report);
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("corrected by"), std::string::npos) << *said;
  const RobotState own = frame.now().toLocal(report);
  EXPECT_NEAR((own.pose.position - 43.1 * kVelocity).norm(), 0.0, 0.01);
  EXPECT_NEAR(own.pose.yaw, 0.0, 1e-3);
  EXPECT_NEAR((own.velocity - kVelocity).norm(), 0.0, 1e-3);
  EXPECT_FALSE(frame.take(reportAt(43.2, slam)));  // once
}

TEST(MissionFrame, TakesSmallLoopClosuresToo) {
  MissionFrame frame = flownTo(10.0);
  const Shift slam(Eigen::Vector3d(0.75, 0.5, 0.05), 0.0);
  EXPECT_TRUE(frame.take(reportAt(10.1, slam)));
}

TEST(MissionFrame, TakesATurnOnThePlace) {
  MissionFrame frame(RobotModel(), kResolution_m);
  RobotState state;
  EXPECT_FALSE(frame.take(state));
  state.stamp_s = 0.1;
  state.pose.yaw = 15.0 * kDegree;
  state.velocity = {0.01, 0.0, 0.0};
  EXPECT_TRUE(frame.take(state));
}

TEST(MissionFrame, LeavesWhatNoDriftExplainsToTheMission) {
  MissionFrame frame = flownTo(20.0);
  EXPECT_FALSE(frame.take(reportAt(20.1, Shift(Eigen::Vector3d(50.0, 0.0, 0.0), 0.0))));
  EXPECT_FALSE(frame.take(reportAt(20.2, Shift())));
  EXPECT_TRUE(frame.now().isCallers());
}

TEST(MissionFrame, IsAsBeforeAfterAJumpToAndFro) {
  MissionFrame frame = flownTo(20.0);
  EXPECT_TRUE(frame.take(reportAt(20.1, Shift(Eigen::Vector3d(1.0, 0.0, 0.0), 0.0))));
  EXPECT_TRUE(frame.take(reportAt(20.2, Shift())));
  EXPECT_NEAR(frame.now().origin().norm(), 0.0, 0.01);
}

TEST(MissionFrame, DoesNotFollowOdometryThatJumpsAgainAndAgain) {
  MissionFrame frame = flownTo(20.0);
  int taken = 0;
  for (int k = 1; k <= 40; ++k) {
    const Shift other(Eigen::Vector3d(k % 2 == 1 ? 1.0 : 0.0, 0.0, 0.0), 0.0);
    if (frame.take(reportAt(20.0 + k * kStep_s, other))) ++taken;
  }
  EXPECT_EQ(taken, 5);
}

TEST(MissionFrame, TakesNoFastTurnOrBrakeForACorrectionAtALowRate) {
  MissionFrame frame(RobotModel(), kResolution_m);
  RobotState state;
  state.velocity = {2.0, 0.0, 0.0};
  EXPECT_FALSE(frame.take(state));
  state.stamp_s = 1.25;  // braked at 2 m/s2
  state.pose.position = {1.0, 0.0, 0.0};
  state.velocity.setZero();
  EXPECT_FALSE(frame.take(state));
}

TEST(MissionFrame, KnowsTheFrameOfWhatWasMeasuredBefore) {
  MissionFrame frame = flownTo(43.0);
  const Shift slam(Eigen::Vector3d(1.5, 1.0, 0.1), 3.0 * kDegree);
  ASSERT_TRUE(frame.take(reportAt(43.1, slam)));
  ASSERT_TRUE(frame.at(42.9));
  EXPECT_TRUE(frame.at(42.9)->isCallers());
  EXPECT_FALSE(frame.at(43.05));  // nobody knows on which side
  ASSERT_TRUE(frame.at(43.1));
  EXPECT_EQ(*frame.at(43.1), frame.now());
  frame.forgetPast();
  EXPECT_EQ(*frame.at(42.9), frame.now());
}

}  // namespace
}  // namespace spelunk::mission
