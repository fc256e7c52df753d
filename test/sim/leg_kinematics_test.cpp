#include "spelunk/sim/leg_kinematics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/rng.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;

/// Angles within the joints' limits, the knee bent to its side.
LegAngles randomAngles(const WalkerParams& params, std::size_t leg, Rng& rng) {
  const double bend = rng.uniform(params.knee_min_deg, params.knee_max_deg) * kDegree;
  return {rng.uniform(-params.abduction_max_deg, params.abduction_max_deg) * kDegree,
          rng.uniform(-60.0, 60.0) * kDegree, leg < 2 ? -bend : bend};
}

TEST(LegKinematics, AnglesOfAFootPutTheFootThere) {
  const WalkerParams params;
  Rng rng(1);
  int reached = 0;
  for (int k = 0; k < 4000; ++k) {
    const std::size_t index = static_cast<std::size_t>(rng.below(4));
    const Leg leg(params, index);
    const LegAngles given = randomAngles(params, index, rng);
    const double below = params.thigh_m * std::cos(given.flexion) +
                         params.shank_m * std::cos(given.flexion + given.knee);
    if (below < 0.01) continue;  // folded above its hip, where only the lower branch is solved
    const Vector3d foot = leg.footAt(given);
    const auto found = leg.anglesFor(foot);
    ASSERT_TRUE(found);
    ++reached;
    EXPECT_LT((leg.footAt(*found) - foot).norm(), 1e-12);
    EXPECT_NEAR(found->abduction, given.abduction, 1e-6);
    EXPECT_NEAR(found->flexion, given.flexion, 1e-6);
    EXPECT_NEAR(found->knee, given.knee, 1e-6);
  }
  EXPECT_GT(reached, 3000);
}

TEST(LegKinematics, WhatItRefusesNoAnglesReach) {
  const WalkerParams params;
  const Leg leg(params, 0);
  Rng rng(2);
  int refused = 0;
  for (int k = 0; k < 60; ++k) {
    const Vector3d foot = leg.root() + Vector3d(rng.uniform(-0.7, 0.7), rng.uniform(-0.5, 0.5),
                                                rng.uniform(-0.8, -0.05));
    if (leg.anglesFor(foot)) continue;
    ++refused;
    double nearest = 1e9;
    for (double a = -params.abduction_max_deg; a <= params.abduction_max_deg; a += 3.0)
      for (double f = -params.flexion_max_deg; f <= params.flexion_max_deg; f += 4.0)
        for (double b = params.knee_min_deg; b <= params.knee_max_deg; b += 5.0)
          nearest = std::min(nearest,
                             (leg.footAt({a * kDegree, f * kDegree, -b * kDegree}) - foot).norm());
    EXPECT_GT(nearest, 1e-3) << foot.transpose();
  }
  EXPECT_GT(refused, 15);
}

TEST(LegKinematics, LegsMirrorEachOther) {
  const auto legs = legsOf(WalkerParams{});
  const LegAngles left{0.2, 0.4, -0.9};
  const LegAngles right{-0.2, 0.4, -0.9};
  const LegAngles hind{0.2, -0.4, 0.9};
  const Vector3d foot = legs[0].footAt(left);
  EXPECT_LT((legs[1].footAt(right) - foot.cwiseProduct(Vector3d(1, -1, 1))).norm(), 1e-12);
  EXPECT_LT((legs[2].footAt(hind) - foot.cwiseProduct(Vector3d(-1, 1, 1))).norm(), 1e-12);
}

TEST(LegKinematics, ReachEndsAtTheKneesLimits) {
  const WalkerParams params;
  const Leg leg(params, 3);
  const auto below = [&](double length) -> Vector3d { return leg.root() - Vector3d(0, 0, length); };
  EXPECT_TRUE(leg.anglesFor(below(leg.longest() - 1e-6)));
  EXPECT_FALSE(leg.anglesFor(below(leg.longest() + 1e-6)));
  EXPECT_TRUE(leg.anglesFor(below(leg.shortest() + 1e-6)));
  EXPECT_FALSE(leg.anglesFor(below(leg.shortest() - 1e-6)));
  EXPECT_LT(leg.longest(), params.thigh_m + params.shank_m);
}

TEST(LegKinematics, KneesPointInward) {
  const auto legs = legsOf(WalkerParams{});
  for (std::size_t k = 0; k < kLegs; ++k) {
    const auto angles = legs[k].anglesFor(legs[k].root() - Vector3d(0, 0, 0.5));
    ASSERT_TRUE(angles);
    EXPECT_EQ(angles->knee < 0.0, k < 2) << kLegNames[k];
  }
}

}  // namespace
}  // namespace spelunk::sim
