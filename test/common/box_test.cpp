#include "spelunk/common/box.h"

#include <gtest/gtest.h>

#include "spelunk/common/rng.h"

namespace spelunk {
namespace {

NoGoZone unitSquare() { return {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.0, 2.0}; }

TEST(NoGoZone, ContainsItsInsideAndBorderButNotItsOutside) {
  EXPECT_TRUE(contains(unitSquare(), {0.5, 0.5, 1.0}));
  EXPECT_TRUE(contains(unitSquare(), {1.0, 0.5, 2.0}));
  EXPECT_FALSE(contains(unitSquare(), {1.01, 0.5, 1.0}));
  EXPECT_FALSE(contains(unitSquare(), {0.5, 0.5, 2.01}));
}

TEST(NoGoZone, ConcavePolygonLeavesItsBayFree) {
  const NoGoZone zone{"u", {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}};
  EXPECT_FALSE(contains(zone, {1.5, 2.0, 0.0}));
  EXPECT_TRUE(contains(zone, {0.5, 2.0, 0.0}));
}

TEST(NoGoZone, SweepThatJumpsAcrossAZoneMeetsIt) {
  const Eigen::Vector3d box(0.2, 0.2, 0.2);
  EXPECT_TRUE(sweptBoxMeets(unitSquare(), {-5, 0.5, 1}, {5, 0.5, 1}, box));
  EXPECT_FALSE(sweptBoxMeets(unitSquare(), {-5, 1.2, 1}, {5, 1.2, 1}, box));
  EXPECT_TRUE(sweptBoxMeets(unitSquare(), {-5, 1.05, 1}, {5, 1.05, 1}, box));
  EXPECT_FALSE(sweptBoxMeets(unitSquare(), {-5, 0.5, 2.2}, {5, 0.5, 2.2}, box));
}

TEST(NoGoZone, SweepNeverSaysNoWhereASampledBoxCornerIsInside) {
  Rng rng(3);
  const NoGoZone zone{"triangle", {{0, 0}, {4, 1}, {1, 3}}, -1.0, 1.0};
  const Eigen::Vector3d box(0.8, 0.5, 0.4);
  int met = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d a(rng.uniform(-3, 6), rng.uniform(-3, 6), rng.uniform(-2, 2));
    const Eigen::Vector3d b(rng.uniform(-3, 6), rng.uniform(-3, 6), rng.uniform(-2, 2));
    bool corner_inside = false;
    for (int step = 0; step <= 50; ++step)
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d offset((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.5 : -0.5,
                                     (corner & 4) ? 0.5 : -0.5);
        corner_inside |= contains(zone, a + step / 50.0 * (b - a) + offset.cwiseProduct(box));
      }
    if (!corner_inside) continue;
    ++met;
    EXPECT_TRUE(sweptBoxMeets(zone, a, b, box));
  }
  EXPECT_GT(met, 200);
}

TEST(AxisAlignedBox, IntersectionOfPartedBoxesIsEmpty) {
  const auto left = boxAround({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(intersection(left, boxAround({2, 0, 0}, {1, 1, 1})).isEmpty());
  EXPECT_FALSE(intersection(left, boxAround({0.9, 0, 0}, {1, 1, 1})).isEmpty());
}

}  // namespace
}  // namespace spelunk
