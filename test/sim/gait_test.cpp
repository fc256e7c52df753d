#include "spelunk/sim/gait.h"

#include <gtest/gtest.h>

#include <array>

#include "spelunk/sim/leg_kinematics.h"

namespace spelunk::sim {
namespace {

WalkerParams gaitParams(const char* name, double duty) {
  WalkerParams params;
  params.gait = name;
  params.duty_factor = duty;
  return params;
}

TEST(Gait, EveryLegStandsItsShareOfThePeriod) {
  for (const auto& params : {gaitParams("trot", 0.6), gaitParams("walk", 0.8)}) {
    Gait gait(params);
    std::array<int, kLegs> stands{};
    for (int k = 0; k < 6000; ++k) {
      gait.advance(params.gait_period_s / 1000.0);
      for (std::size_t leg = 0; leg < kLegs; ++leg) stands[leg] += gait.isStance(leg) ? 1 : 0;
    }
    for (const int count : stands) EXPECT_NEAR(count, 6000 * params.duty_factor, 12);
    EXPECT_NEAR(gait.stanceTime() + gait.swingTime(), params.gait_period_s, 1e-12);
  }
}

TEST(Gait, TrotSwingsDiagonalPairsAndNeverBoth) {
  Gait gait(gaitParams("trot", 0.6));
  for (int k = 0; k < 1000; ++k) {
    gait.advance(0.003);
    EXPECT_EQ(gait.isStance(0), gait.isStance(3));
    EXPECT_EQ(gait.isStance(1), gait.isStance(2));
    EXPECT_TRUE(gait.isStance(0) || gait.isStance(1));
  }
}

TEST(Gait, WalkSwingsOneLegAtATimeHindBeforeFront) {
  Gait gait(gaitParams("walk", 0.78));
  std::vector<std::size_t> order;
  for (int k = 0; k < 1000; ++k) {
    gait.advance(0.002);
    std::vector<std::size_t> swinging;
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      if (!gait.isStance(leg)) swinging.push_back(leg);
    ASSERT_LE(swinging.size(), 1U);
    if (!swinging.empty() && (order.empty() || order.back() != swinging[0]))
      order.push_back(swinging[0]);
  }
  ASSERT_GE(order.size(), 5U);
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    // left hind, left front, right hind, right front
    constexpr std::array<std::size_t, kLegs> kNext{3, 2, 0, 1};
    EXPECT_EQ(order[k + 1], kNext[order[k]]);
  }
}

TEST(Gait, SwingLeftCountsDownToTheTouchdown) {
  Gait gait(gaitParams("trot", 0.6));
  gait.restart();
  while (gait.isStance(0)) gait.advance(0.001);
  EXPECT_NEAR(gait.swingLeft(0), gait.swingTime(), 0.002);
  gait.advance(0.1);
  EXPECT_NEAR(gait.swingLeft(0), gait.swingTime() - 0.1, 0.002);
  gait.advance(gait.swingTime() - 0.1);
  EXPECT_TRUE(gait.isStance(0));
  EXPECT_EQ(gait.swingLeft(0), 0.0);
}

}  // namespace
}  // namespace spelunk::sim
