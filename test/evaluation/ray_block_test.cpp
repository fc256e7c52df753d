#include "evaluation/ray_block.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/eight_walks.h"
#include "spelunk/common/rng.h"

namespace spelunk::evaluation {
namespace {

const AxisAlignedBox kBounds{{-4.0, -3.0, -2.0}, {4.0, 5.0, 3.0}};
constexpr double kEdge_m = 0.2;

RayBlock raysFrom(const Eigen::Vector3d& point, std::size_t count, Rng& rng) {
  RayBlock rays;
  rays.from = VoxelGrid(kBounds, kEdge_m).scaled(point);
  rays.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d direction(rng.normal(), rng.normal(), rng.normal());
    for (int axis = 0; axis < 3; ++axis)  // some rays along axes and planes
      if (rng.below(8) == 0) direction[axis] = 0.0;
    if (direction.isZero()) direction = -Eigen::Vector3d::UnitY();
    direction.normalize();
    rays.x[i] = direction.x();
    rays.y[i] = direction.y();
    rays.z[i] = direction.z();
    rays.length[i] = rng.uniform(0.0, 80.0);
  }
  return rays;
}

TEST(RayBlock, EightRaysAtOnceMarkTheSameVoxelsAsOne) {
  if (!hasEightLanes()) GTEST_SKIP() << "needs AVX-512";
  Rng rng(7);
  VoxelGrid by_eights(kBounds, kEdge_m);
  VoxelGrid one_by_one(kBounds, kEdge_m);
  for (const std::size_t count : {0, 1, 3, 8, 15, 16, 17, 100, 256}) {
    const Eigen::Vector3d corner = 0.2 * Eigen::Vector3d(rng.below(9), rng.below(9), 0.0);
    const Eigen::Vector3d inside(rng.uniform(-3.9, 3.9), rng.uniform(-2.9, 4.9), 0.5);
    for (const Eigen::Vector3d& point : {corner, inside}) {
      const RayBlock rays = raysFrom(point, count, rng);
      EXPECT_EQ(markByEights(rays, by_eights), markOneByOne(rays, one_by_one)) << count;
    }
  }
  std::size_t set = 0;
  by_eights.forEachSet([&](std::size_t offset) {
    ++set;
    EXPECT_TRUE(one_by_one.isSet(offset));
  });
  EXPECT_GT(set, 1000U);
  one_by_one.forEachSet([&](std::size_t) { --set; });
  EXPECT_EQ(set, 0U);
}

TEST(RayBlock, EveryVoxelIsCountedOnce) {
  Rng rng(3);
  VoxelGrid grid(kBounds, kEdge_m);
  const RayBlock rays = raysFrom({0.1, 0.2, 0.3}, 256, rng);
  const std::size_t found = mark(rays, grid);
  std::size_t set = 0;
  grid.forEachSet([&](std::size_t) { ++set; });
  EXPECT_EQ(found, set);
  EXPECT_EQ(mark(rays, grid), 0U);
}

}  // namespace
}  // namespace spelunk::evaluation
