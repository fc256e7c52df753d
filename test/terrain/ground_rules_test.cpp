#include "spelunk/terrain/ground_rules.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spelunk::terrain {
namespace {

const GroundRules kRules{0.75, 22.0 * M_PI / 180.0, 0.2, 0.15};

/// Ground of a known height; beyond the distance looked at there is only free space.
template <class Height>
GroundLookup groundOf(Height height) {
  return [height](const Eigen::Vector3d& point, double distance_m) -> GroundBelow {
    const double z = height(point.x());
    if (z > point.z()) return {GroundSearch::kInOccupied, point.z()};
    if (point.z() - z > distance_m) return {GroundSearch::kTooFar, point.z() - distance_m};
    return {GroundSearch::kFound, z};
  };
}

/// The way over ground of that height, each end at the robot's height.
template <class Height>
Footing footingOver(Height height, double from_x, double to_x) {
  return footingAlong({from_x, 0.0, height(from_x) + kRules.height_m},
                      {to_x, 0.0, height(to_x) + kRules.height_m}, kRules, groundOf(height));
}

TEST(GroundRules, WalkSlopesUpToTheLimitAndNoSteeperOnes) {
  const auto slope = [](double degrees) {
    return [rise = std::tan(degrees * M_PI / 180.0)](double x) { return rise * x; };
  };
  EXPECT_EQ(footingOver(slope(0.0), 0.0, 6.0), Footing::kGood);
  EXPECT_EQ(footingOver(slope(20.0), 0.0, 6.0), Footing::kGood);
  EXPECT_EQ(footingOver(slope(-20.0), 0.0, 6.0), Footing::kGood);
  EXPECT_EQ(footingOver(slope(30.0), 0.0, 6.0), Footing::kTooSteep);
  EXPECT_EQ(footingOver(slope(-30.0), 0.0, 6.0), Footing::kTooSteep);
}

TEST(GroundRules, TakeSmallStepsAndRefuseHighOnes) {
  const auto step = [](double rise) { return [rise](double x) { return x < 1.5 ? 0.0 : rise; }; };
  EXPECT_EQ(footingOver(step(0.15), 0.0, 3.0), Footing::kGood);
  EXPECT_EQ(footingOver(step(-0.15), 0.0, 3.0), Footing::kGood);
  EXPECT_NE(footingOver(step(0.9), 1.2, 1.8), Footing::kGood);
  EXPECT_NE(footingOver(step(-0.9), 1.2, 1.8), Footing::kGood);
}

TEST(GroundRules, SeeAHoleBetweenGoodEnds) {
  const auto hole = [](double x) { return x > 1.0 && x < 1.8 ? -1.0 : 0.0; };
  EXPECT_EQ(footingOver(hole, 0.0, 3.0), Footing::kNone);
  EXPECT_EQ(footingOver(hole, 2.0, 4.0), Footing::kGood);
}

TEST(GroundRules, PresumeUnknownGroundUnlessFreeSpaceLiesWhereItShouldBe) {
  const auto unknown = [](double lowest_free_z) -> GroundLookup {
    return [=](const Eigen::Vector3d&, double) -> GroundBelow {
      return {GroundSearch::kUnknown, lowest_free_z};
    };
  };
  const Eigen::Vector3d a(0.0, 0.0, kRules.height_m);
  const Eigen::Vector3d b(2.0, 0.0, kRules.height_m);
  EXPECT_EQ(footingAlong(a, b, kRules, unknown(0.2)), Footing::kGood);
  EXPECT_EQ(footingAlong(a, b, kRules, unknown(-0.6)), Footing::kNone);
}

TEST(GroundRules, PutPointsOnTheGroundBelowThem) {
  const auto slope = groundOf([](double x) { return 0.2 * x; });
  const Eigen::Vector3d from(0.0, 0.0, kRules.height_m);
  const auto placed = placedOnGround({2.0, 1.0, 2.5}, from, kRules, slope);
  ASSERT_TRUE(placed);
  EXPECT_TRUE(placed->isApprox(Eigen::Vector3d(2.0, 1.0, 0.4 + kRules.height_m)));
  const auto abyss = groundOf([](double) { return -50.0; });
  EXPECT_FALSE(placedOnGround({2.0, 1.0, 2.5}, from, kRules, abyss));
  const GroundLookup unknown = [](const Eigen::Vector3d& point, double) -> GroundBelow {
    return {GroundSearch::kUnknown, point.z()};
  };
  EXPECT_DOUBLE_EQ(placedOnGround({2.0, 1.0, 2.5}, from, kRules, unknown)->z(), from.z());
}

/// Ground that is hidden everywhere: free space was seen down to that height.
template <class Height>
GroundLookup hiddenBelow(Height height) {
  return [height](const Eigen::Vector3d& point, double) -> GroundBelow {
    return {GroundSearch::kUnknown, height(point.x())};
  };
}

TEST(GroundRules, FollowHiddenGroundDownASlopeButNotIntoAShaft) {
  const Eigen::Vector3d from(0.0, 0.0, kRules.height_m);
  const auto slope = hiddenBelow([](double x) { return -0.3 * x; });
  const auto down = placedOnGround({2.0, 0.0, kRules.height_m}, from, kRules, slope);
  ASSERT_TRUE(down);
  EXPECT_NEAR(down->z(), kRules.height_m - 0.6, 1e-12);
  EXPECT_EQ(footingAlong(from, *down, kRules, slope), Footing::kGood);

  const auto shaft = hiddenBelow([](double x) { return x < 1.0 ? 0.0 : -2.5; });
  const auto into = placedOnGround({2.0, 0.0, kRules.height_m}, from, kRules, shaft);
  ASSERT_TRUE(into);
  EXPECT_EQ(footingAlong(from, *into, kRules, shaft), Footing::kTooSteep);
}

TEST(GroundRules, OfARobotAddItsHeights) {
  RobotModel robot;
  robot.ride_height_m = 0.5;
  robot.box_lift_m = 0.25;
  robot.slope_max_deg = 45.0;
  const GroundRules rules = GroundRules::of(robot, 0.1);
  EXPECT_DOUBLE_EQ(rules.height_m, 0.75);
  EXPECT_NEAR(std::tan(rules.slope_max_rad), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(rules.voxel_m, 0.1);
}

}  // namespace
}  // namespace spelunk::terrain
