#include "spelunk/navigation/swept_path_check.h"

#include <gtest/gtest.h>

#include "spelunk/common/contract.h"
#include "support/grid_world.h"

namespace spelunk::navigation {
namespace {

const Eigen::Vector3d kBox(0.8, 0.8, 0.4);

std::shared_ptr<const map::FrozenMap> frozen(const test::GridWorld& world) {
  map::MapParams params;
  params.resolution_m = 0.25;
  params.range_min_m = 0.0;
  map::OccupancyMap map(params);
  world.enterInto(map);
  return map.freeze();
}

test::GridWorld pillarHall() {
  test::GridWorld world({50, 30, 8}, 0.5);
  world.carve({{0.5, 0.5, 0.5}, {24.5, 14.5, 3.5}});
  Rng rng(8);
  for (int k = 0; k < 12; ++k) {
    const Eigen::Vector3d low(rng.uniform(2.0, 22.0), rng.uniform(2.0, 12.0), 0.5);
    world.block({low, low + Eigen::Vector3d(1.0, 1.0, 3.0)});
  }
  return world;
}

/// Plain way: every voxel the box touches at steps of a centimetre.
bool bruteForceFree(const map::FrozenMap& map, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const int steps = std::max(1, static_cast<int>((b - a).norm() / 0.01));
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector3d centre = a + (b - a) * k / steps;
    const map::VoxelIndex low = map.indexOf(centre - 0.5 * kBox);
    const map::VoxelIndex high = map.indexOf(centre + 0.5 * kBox);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          if (map.at(map::VoxelIndex(x, y, z)) != map::Occupancy::kFree) return false;
  }
  return true;
}

TEST(SweptPathCheck, NeverCallsASweepFreeThatTouchesAnything) {
  const auto map = frozen(pillarHall());
  map::ConfigurationSpace space(kBox, map);
  Rng rng(9);
  int free = 0;
  int agree = 0;
  constexpr int kSegments = 400;
  for (int k = 0; k < kSegments; ++k) {
    const Eigen::Vector3d a(rng.uniform(0.0, 25.0), rng.uniform(0.0, 15.0), rng.uniform(0.8, 3.2));
    const Eigen::Vector3d b =
        a + Eigen::Vector3d(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-0.5, 0.5));
    const bool answer = checkPath(space, {{a, 0.0}, {b, 0.0}}, {}, {}).isFree();
    const bool expected = bruteForceFree(*map, a, b);
    EXPECT_TRUE(expected || !answer);
    free += expected ? 1 : 0;
    agree += answer == expected ? 1 : 0;
  }
  EXPECT_GT(free, 30);
  EXPECT_GT(agree, kSegments * 95 / 100);
}

TEST(SweptPathCheck, SaysWhereAndWhy) {
  test::GridWorld world = test::corridorWorld(30.0);
  world.block({{20.0, 1.0, 1.0}, {20.5, 4.0, 4.0}});
  const auto map = frozen(world);
  const Path path{{{3.0, 2.5, 2.5}, 0.0}, {{10.0, 2.5, 2.5}, 0.0}, {{25.0, 2.5, 2.5}, 0.0}};
  map::ConfigurationSpace space(kBox, map);
  const PathCheck check = checkPath(space, path, {}, {});
  EXPECT_EQ(check.fault, PathFault::kOccupied);
  EXPECT_LE(check.arc_m, 17.0 - 0.4);
  EXPECT_GT(check.arc_m, 17.0 - 1.2);
  const PathCheck free = checkPath(space, slice(path, 0.0, 15.0), {}, {});
  EXPECT_TRUE(free.isFree());
  EXPECT_NEAR(free.arc_m, 15.0, 1e-9);
}

TEST(SweptPathCheck, UnknownIsNeverFree) {
  map::OccupancyMap map(map::MapParams{});
  map::ConfigurationSpace space(kBox, map.freeze());
  const PathCheck check =
      checkPath(space, {{{0.0, 0.0, 0.0}, 0.0}, {{3.0, 0.0, 0.0}, 0.0}}, {}, {});
  EXPECT_EQ(check.fault, PathFault::kUnknown);
  EXPECT_EQ(check.arc_m, 0.0);
}

TEST(SweptPathCheck, BoundsAndZonesComeFirst) {
  map::ConfigurationSpace space(kBox, frozen(test::corridorWorld(30.0)));
  const Path path{{{3.0, 2.5, 2.5}, 0.0}, {{8.0, 2.5, 2.5}, 0.0}, {{20.0, 2.5, 2.5}, 0.0}};
  AxisAlignedBox bounds;
  bounds.max.x() = 15.0;
  EXPECT_EQ(checkPath(space, path, {}, bounds).fault, PathFault::kOutOfBounds);
  NoGoZone zone;
  zone.name = "sump";
  zone.polygon = {{10.0, 0.0}, {11.0, 0.0}, {11.0, 5.0}, {10.0, 5.0}};
  const PathCheck check = checkPath(space, path, {zone}, {});
  EXPECT_EQ(check.fault, PathFault::kNoGo);
  EXPECT_EQ(check.zone, "sump");
  EXPECT_NEAR(check.arc_m, 5.0, 1e-9);
}

TEST(SweptPathCheck, EmptyPathBreaksTheContract) {
  map::OccupancyMap map(map::MapParams{});
  map::ConfigurationSpace space(kBox, map.freeze());
  EXPECT_THROW(static_cast<void>(checkPath(space, {}, {}, {})), Precondition);
}

}  // namespace
}  // namespace spelunk::navigation
