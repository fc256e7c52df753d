#include "spelunk/sim/odometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spelunk::sim {
namespace {

/// Flies along x to `length_m`; returns where the odometry believes to be.
BodyState flown(double drift, double noise_m, double length_m, std::uint64_t seed) {
  BodyState body;
  Odometry odometry(drift, noise_m, body, Rng(seed));
  const int steps = static_cast<int>(length_m / 0.01);
  for (int k = 1; k <= steps; ++k) {
    body.position.x() = 0.01 * k;
    odometry.advance(body);
  }
  return odometry.measurement();
}

TEST(Odometry, IsTheTruthWithoutErrors) {
  const BodyState end = flown(0.0, 0.0, 20.0, 1);
  EXPECT_EQ(end.position, Eigen::Vector3d(0.01 * 2000, 0.0, 0.0));
  EXPECT_EQ(end.orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(Odometry, DriftGrowsWithTheRootOfTheDistance) {
  const auto rms = [](double length_m) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const Eigen::Vector3d error =
          flown(0.02, 0.0, length_m, seed).position - Eigen::Vector3d(length_m, 0.0, 0.0);
      sum += error.squaredNorm();
    }
    return std::sqrt(sum / 200.0);
  };
  EXPECT_NEAR(rms(1.0), 0.02, 0.004);
  EXPECT_NEAR(rms(4.0), 0.04, 0.008);
}

TEST(Odometry, HeadingDriftsToo) {
  const BodyState end = flown(0.05, 0.0, 10.0, 3);
  EXPECT_GT(end.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-4);
  EXPECT_LT(end.orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.1);
}

TEST(Odometry, StandingStillDoesNotDrift) {
  BodyState body;
  Odometry odometry(0.1, 0.0, body, Rng(1));
  for (int k = 0; k < 1000; ++k) odometry.advance(body);
  EXPECT_EQ(odometry.measurement().position, Eigen::Vector3d::Zero());
}

TEST(Odometry, NoiseIsWhiteAndTheSameUntilTheNextStep) {
  BodyState body;
  Odometry odometry(0.0, 0.05, body, Rng(1));
  double sum = 0.0;
  double product = 0.0;
  double last = 0.0;
  for (int k = 0; k < 4000; ++k) {
    odometry.advance(body);
    const double x = odometry.measurement().position.x();
    EXPECT_EQ(odometry.measurement().position.x(), x);
    EXPECT_EQ(odometry.estimate().position.x(), 0.0);
    sum += x * x;
    product += x * last;
    last = x;
  }
  EXPECT_NEAR(std::sqrt(sum / 4000.0), 0.05, 0.003);
  EXPECT_NEAR(product / 4000.0, 0.0, 0.0002);
}

}  // namespace
}  // namespace spelunk::sim
