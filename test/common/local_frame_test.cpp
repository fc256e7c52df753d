#include "spelunk/common/local_frame.h"

#include <gtest/gtest.h>

#include <limits>

namespace spelunk {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kKeyRange_m = 4913.0;
const Eigen::Vector3d kUtm(467000.0, 5420000.0, 300.0);

TEST(LocalFrame, IsTheCallersOwnWhereAllWithinReachHasKeys) {
  EXPECT_TRUE(LocalFrame::around({-3900.0, 40.0, 3.0}, 950.0, kKeyRange_m).isCallers());
  EXPECT_FALSE(LocalFrame::around({-3990.0, 40.0, 3.0}, 950.0, kKeyRange_m).isCallers());
}

TEST(LocalFrame, IsTheCallersOwnOnlyWhereFloatsHaveMillimetres) {
  EXPECT_TRUE(LocalFrame::around({7000.0, 0.0, 0.0}, 950.0, 30000.0).isCallers());
  EXPECT_FALSE(LocalFrame::around({9000.0, 0.0, 0.0}, 950.0, 30000.0).isCallers());
}

TEST(LocalFrame, HasItsOriginAtTheHundredsOfMetresNearTheFirstPose) {
  const LocalFrame frame = LocalFrame::around({467012.5, 5419960.0, 301.5}, 950.0, kKeyRange_m);
  EXPECT_EQ(frame.origin(), kUtm);
  EXPECT_EQ(frame.toLocal(Eigen::Vector3d(467012.5, 5419960.0, 301.5)),
            Eigen::Vector3d(12.5, -40.0, 1.5));
}

TEST(LocalFrame, KeepsARobotOfAnyReachNearTheCallersOrigin) {
  EXPECT_TRUE(LocalFrame::around({20.0, -30.0, 3.0}, 1e6, kKeyRange_m).isCallers());
}

TEST(LocalFrame, GivesBackWhatItTook) {
  const LocalFrame frame(kUtm);
  const Pose pose{{467001.125, 5419999.25, 301.5}, 0.5};
  const Path there{pose, pose};
  EXPECT_EQ(frame.toCaller(frame.toLocal(pose)).position, pose.position);
  EXPECT_EQ(frame.toCaller(frame.toLocal(there)).back().position, pose.position);
  EXPECT_EQ(frame.toLocal(there).front().position, Eigen::Vector3d(1.125, -0.75, 1.5));
}

TEST(LocalFrame, TakesWrittenDecimalsAsTheyAre) {
  EXPECT_EQ(LocalFrame(kUtm).written(Eigen::Vector3d(467002.3, 5420000.7, 301.1)),
            Eigen::Vector3d(2.3, 0.7, 1.1));
  EXPECT_EQ(LocalFrame().written(Eigen::Vector3d(0.1, 1e-9, 3.0)), Eigen::Vector3d(0.1, 1e-9, 3.0));
}

TEST(LocalFrame, LeavesOpenSidesOfBoundsAndZonesOpen) {
  const LocalFrame frame(kUtm);
  const AxisAlignedBox box = frame.toLocal(
      AxisAlignedBox{{467001.0, -kInfinity, 300.0}, {467005.0, 5420002.0, kInfinity}});
  EXPECT_EQ(box.min, Eigen::Vector3d(1.0, -kInfinity, 0.0));
  EXPECT_EQ(box.max, Eigen::Vector3d(5.0, 2.0, kInfinity));
  const NoGoZone zone =
      frame.toLocal(NoGoZone{"shaft", {{467001.0, 5420001.0}}, -kInfinity, 310.0});
  EXPECT_EQ(zone.polygon.front(), Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(zone.z_min, -kInfinity);
  EXPECT_EQ(zone.z_max, 10.0);
}

TEST(LocalFrame, MovesThePlacesThatASentenceNamesAndNothingElse) {
  const LocalFrame frame(kUtm);
  const std::string text = "blocked at (1.0, -2.25, 3), 4.5 m away (3 of 5, 7)";
  EXPECT_EQ(frame.toCaller(text), "blocked at (467001.0, 5419997.75, 303), 4.5 m away (3 of 5, 7)");
  EXPECT_EQ(LocalFrame().toCaller(text), text);
}

TEST(LocalFrame, StaysWithTheRobotWhenTheCallersFrameIsCorrected) {
  const Pose before{{43.0, 2.0, 1.5}, 0.4};
  const Pose after{{44.5, 3.0, 1.6}, 0.45};
  const LocalFrame frame = LocalFrame().corrected(shiftBetween(before, after));
  EXPECT_FALSE(frame.isCallers());
  EXPECT_LT(distance(frame.toLocal(after), before), 1e-9);
  EXPECT_NEAR(frame.toLocal(after).yaw, before.yaw, 1e-9);
  const Path path{before, {{40.0, -3.0, 1.0}, -3.1}};
  EXPECT_LT(distance(frame.toLocal(frame.toCaller(path)).back(), path.back()), 1e-9);
  EXPECT_EQ(frame.toCaller(std::string("at (43.00, 2.00, 1.50)")), "at (44.50, 3.00, 1.60)");
}

TEST(LocalFrame, TakesTwoCorrectionsOneAfterTheOther) {
  const Pose a{{1.0, 2.0, 3.0}, 0.1};
  const Pose b{{1.5, 2.5, 3.0}, 0.2};
  const Pose c{{0.5, 2.0, 3.1}, -0.3};
  const LocalFrame frame =
      LocalFrame(kUtm).corrected(shiftBetween(a, b)).corrected(shiftBetween(b, c));
  EXPECT_LT(distance(frame.toLocal(c), LocalFrame(kUtm).toLocal(a)), 1e-6);
  EXPECT_NEAR(frame.toLocal(c).yaw, a.yaw, 1e-9);
}

TEST(LocalFrame, KeepsBoundsParallelAndRightNearTheRobot) {
  const Pose before{{43.0, 2.0, 1.5}, 0.4};
  const Pose after{{44.5, 3.0, 1.6}, 0.45};
  const LocalFrame frame = LocalFrame().corrected(shiftBetween(before, after));
  const AxisAlignedBox box{{40.0, -kInfinity, 0.0}, {50.0, 6.0, 4.0}};
  const AxisAlignedBox there = frame.toCaller(box);
  EXPECT_LT((there.max - box.max - Eigen::Vector3d(1.5, 1.0, 0.1)).norm(), 1e-9);
  EXPECT_EQ(there.min.y(), -kInfinity);
  EXPECT_LT((frame.toLocal(there).max - box.max).norm(), 1e-9);
}

}  // namespace
}  // namespace spelunk
