#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/rng.h"
#include "spelunk/sim/rock_field.h"
#include "spelunk/sim/rock_noise.h"
#include "spelunk/sim/winding.h"

namespace spelunk::sim {
namespace {

Eigen::Vector3d anyPoint(Rng& rng, double reach) {
  const double x = rng.uniform(-reach, reach);
  const double y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

TEST(RockNoise, StaysInItsRangeAndUsesIt) {
  Rng rng(3);
  double low = 1.0;
  double high = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double value = rockNoise(anyPoint(rng, 200.0), 3.0, 9);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  EXPECT_GE(low, 0.0);
  EXPECT_LE(high, 1.0);
  EXPECT_LT(low, 0.1);
  EXPECT_GT(high, 0.9);
}

TEST(RockNoise, HasNoSteps) {
  Rng rng(4);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d point = anyPoint(rng, 50.0);
    const Eigen::Vector3d beside = point + Eigen::Vector3d(1e-4, -1e-4, 1e-4);
    EXPECT_NEAR(rockNoise(point, 3.0, 9), rockNoise(beside, 3.0, 9), 3e-4);
  }
}

TEST(RockNoise, DiffersFromSeedToSeed) {
  const Eigen::Vector3d point(1.3, -2.4, 0.7);
  EXPECT_NE(rockNoise(point, 3.0, 1), rockNoise(point, 3.0, 2));
  EXPECT_NE(rockNoise(4.2, 3.0, 1), rockNoise(4.2, 3.0, 2));
}

WorldPlan crossing(double roughness_m) {
  WorldPlan plan;
  plan.passages = {{{{{-20, 0, 0}, 3.0, 3.2}, {{20, 0, 0}, 3.0, 3.2}}},
                   {{{{0, -20, 0}, 2.0, 3.0}, {{0, 20, 0}, 2.0, 3.0}}}};
  plan.chambers = {{{12, 0, 0}, {4.0, 3.0}, 4.0}};
  plan.pillars = {{{12.0, 0.0}, {1.5, 1.5}}};
  plan.roughness_m = roughness_m;
  return plan;
}

TEST(RockField, PutsWallsFloorAndRoofWhereThePlanSays) {
  const RockField field(crossing(0.0));
  EXPECT_NEAR(field.at({-10.0, 1.5, 1.0}), 0.0, 1e-9);  // wall
  EXPECT_NEAR(field.at({-10.0, 0.0, 0.0}), 0.0, 1e-9);  // floor
  EXPECT_NEAR(field.at({-10.0, 0.0, 3.2}), 0.0, 1e-9);  // roof
  EXPECT_LT(field.at({-10.0, 0.0, 1.0}), -0.9);
  EXPECT_GT(field.at({-10.0, 4.0, 1.0}), 2.0);
  EXPECT_GT(field.at({12.0, 0.0, 1.0}), 0.5);  // pillar
}

TEST(RockField, RoughnessOnlyCarvesAndNoDeeperThanAsked) {
  const RockField smooth(crossing(0.0));
  const RockField rough(crossing(0.4));
  Rng rng(5);
  double deepest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d point(rng.uniform(-18, 18), rng.uniform(-4, 4), rng.uniform(-1, 4));
    if (std::abs(smooth.at(point)) > 0.6) continue;
    const double carved = smooth.at(point) - rough.at(point);
    EXPECT_GE(carved, -1e-9);
    deepest = std::max(deepest, carved);
  }
  EXPECT_GT(deepest, 0.2);
  EXPECT_LE(deepest, 0.4 + 1e-9);
}

TEST(RockField, ASelectionGivesTheSameSurfaceAsAllSpaces) {
  const WorldPlan plan = crossing(0.3);
  const RockField field(plan);
  const RockField::Selection all = field.select(field.bounds());
  Rng rng(6);
  int near_the_surface = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d point(rng.uniform(-22, 22), rng.uniform(-22, 22), rng.uniform(-1, 5));
    const double value = field.at(point, all);
    if (std::abs(value) > plan.cell_m) continue;
    ++near_the_surface;
    EXPECT_NEAR(value, field.at(point), 1e-9);
  }
  EXPECT_GT(near_the_surface, 500);
}

TEST(WindingPassage, KeepsItsEndsItsWidthsAndItsHeights) {
  Rng rng(7);
  const Eigen::Vector3d from(1.0, 2.0, 0.5);
  const Eigen::Vector3d to(41.0, 12.0, 3.0);
  const Winding winding{2.0, 2.2, 3.4, 2.5, 3.0, 4.0};
  const Passage passage = windingPassage(from, to, winding, rng);
  EXPECT_LT((passage.stations.front().floor - from).norm(), 1e-9);
  EXPECT_LT((passage.stations.back().floor - to).norm(), 1e-9);
  for (const Station& station : passage.stations) {
    EXPECT_GE(station.width, 2.2);
    EXPECT_LE(station.width, 3.4);
    EXPECT_GE(station.height, 2.5);
    EXPECT_LE(station.height, 3.0);
    const Eigen::Vector3d axis = (to - from).normalized();
    const Eigen::Vector3d off = station.floor - from;
    EXPECT_LE((off - off.dot(axis) * axis).norm(), 2.0 + 1e-9);
  }
}

TEST(Thinned, StillJoinsWhatWasJoined) {
  Edges grid;
  for (int place = 0; place < 36; ++place) {
    if (place % 6 != 5) grid.emplace_back(place, place + 1);
    if (place < 30) grid.emplace_back(place, place + 6);
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const Edges tree = thinned(grid, 36, 0.0, rng);
    EXPECT_EQ(tree.size(), 35U);
    std::vector<int> label(36);
    for (int i = 0; i < 36; ++i) label[static_cast<std::size_t>(i)] = i;
    for (const auto& [a, b] : tree) {
      const int old = label[static_cast<std::size_t>(a)];
      const int fresh = label[static_cast<std::size_t>(b)];
      EXPECT_NE(old, fresh) << "a loop";
      std::replace(label.begin(), label.end(), old, fresh);
    }
  }
}

TEST(Thinned, KeepsAllLoopsIfAsked) {
  const Edges triangle{{0, 1}, {1, 2}, {2, 0}};
  Rng rng(1);
  EXPECT_EQ(thinned(triangle, 3, 1.0, rng), triangle);
}

}  // namespace
}  // namespace spelunk::sim
