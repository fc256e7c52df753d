#include "spelunk/planners/gbplanner/exploration_gain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::planners::gbplanner {
namespace {

TEST(ExplorationGain, SumsGainsDiscountedByDistanceAlongThePath) {
  const graph::Polyline path{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}};
  const double expected = 10.0 + 20.0 * std::exp(-0.1 * 3.0) + 40.0 * std::exp(-0.1 * 7.0);
  EXPECT_NEAR(discountedGain(path, {10.0, 20.0, 40.0}, 0.1, PathGainCounting::kSum), expected,
              1e-12);
  EXPECT_NEAR(discountedGain(path, {10.0, 20.0, 40.0}, 0.1, PathGainCounting::kBestVertex),
              40.0 * std::exp(-0.7), 1e-12);
  EXPECT_THROW(static_cast<void>(discountedGain(path, {1.0}, 0.1, PathGainCounting::kSum)),
               Precondition);
}

TEST(ExplorationGain, FindsNoDissimilarityStraightAheadAndMostBackwards) {
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  const double straight = dissimilarity({{0, 0, 0}, {10, 0, 0}}, ahead, 1.0);
  const double aside = dissimilarity({{0, 0, 0}, {0, 10, 0}}, ahead, 1.0);
  const double back = dissimilarity({{0, 0, 0}, {-10, 0, 0}}, ahead, 1.0);
  EXPECT_NEAR(straight, 0.0, 1e-9);
  EXPECT_GT(aside, 20.0);
  EXPECT_GT(back, aside);
  EXPECT_DOUBLE_EQ(similarityFactor(0.0, 0.02), 1.0);
  EXPECT_LT(similarityFactor(back, 0.02), similarityFactor(aside, 0.02));
}

TEST(ExplorationGain, TellsADetourFromAStraightLineWithTheSameEnd) {
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  EXPECT_GT(dissimilarity({{0, 0, 0}, {3, 5, 0}, {6, 0, 0}}, ahead, 0.5), 10.0);
}

TEST(ExplorationGain, HardlyDependsOnHowFinelyPathsAreSampled) {
  const graph::Polyline path{{0, 0, 0}, {5, 5, 0}, {10, 5, 0}};
  const double coarse = dissimilarity(path, Eigen::Vector3d::UnitX(), 1.0);
  const double fine = dissimilarity(path, Eigen::Vector3d::UnitX(), 0.25);
  EXPECT_NEAR(fine / coarse, 1.0, 0.15);
}

TEST(ExplorationTime, TakesBothWaysOffTheRemainingEndurance) {
  EXPECT_DOUBLE_EQ(explorationTime(100.0, 30.0, 50.0), 20.0);
  EXPECT_DOUBLE_EQ(explorationTime(60.0, 30.0, 50.0), -20.0);  // the way out counts too
  EXPECT_DOUBLE_EQ(explorationTime(60.0, 0.0, 50.0), 10.0);
  EXPECT_DOUBLE_EQ(estimatedTime(20.0, 2.0, 1.5), 15.0);
}

TEST(GlobalExplorationGain, FavoursNearFrontiersAndRefusesThoseOutOfBudget) {
  EXPECT_NEAR(globalExplorationGain(20.0, 30.0, 10.0, 0.05), 600.0 * std::exp(-0.5), 1e-9);
  EXPECT_GT(globalExplorationGain(20.0, 30.0, 10.0, 0.05),
            globalExplorationGain(20.0, 30.0, 20.0, 0.05));
  EXPECT_DOUBLE_EQ(globalExplorationGain(-1.0, 30.0, 10.0, 0.05), 0.0);
}

TEST(BelievedGain, IsLessThanInProportionBelowTheThreshold) {
  EXPECT_DOUBLE_EQ(believedGain(900.0, 800.0), 900.0);
  EXPECT_DOUBLE_EQ(believedGain(800.0, 800.0), 800.0);
  EXPECT_DOUBLE_EQ(believedGain(200.0, 800.0), 50.0);
  EXPECT_DOUBLE_EQ(believedGain(5.0, 0.0), 5.0);
}

class AMovingRobot : public ::testing::Test {
 protected:
  PlanRequest request_;
};

TEST_F(AMovingRobot, ExploresInTheDirectionItCameFrom) {
  request_.time_s = 10.0;
  request_.pose.position = {10.0, 0.0, 1.0};
  request_.velocity = {0.0, 1.0, 0.0};
  request_.trail.push_back({0.0, {{10.0, 50.0, 1.0}, 0.0}});  // older than the window
  for (int i = 5; i <= 10; ++i)
    request_.trail.push_back({static_cast<double>(i), {{static_cast<double>(i), 0.0, 1.0}, 0.0}});
  EXPECT_TRUE(exploringDirection(request_, 6.0).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
}

TEST_F(AMovingRobot, FallsBackOnItsVelocityAndThenItsHeading) {
  request_.pose.yaw = M_PI;
  EXPECT_TRUE(exploringDirection(request_, 6.0).isApprox(-Eigen::Vector3d::UnitX(), 1e-9));
  request_.velocity = {0.0, 2.0, 1.0};
  EXPECT_TRUE(exploringDirection(request_, 6.0).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
}

}  // namespace
}  // namespace spelunk::planners::gbplanner
