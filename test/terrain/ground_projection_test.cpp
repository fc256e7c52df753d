#include "spelunk/terrain/ground_projection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "map/map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::terrain {
namespace {

/// Random free, occupied and unknown voxels of 0.2 m in a cube of 16.
map::OccupancyMap randomCube() {
  Rng rng(8);
  return map::randomMap({}, rng, {16, 16, 16}, 0.08, 0.03);
}

TEST(GroundProjection, FindsTheFirstOccupiedVoxelBelow) {
  map::OccupancyMap world = randomCube();
  const auto frozen = world.freeze();
  const map::LocalWindow window(*frozen, {{-1, -1, -1}, {4, 4, 4}});
  Rng rng(1);
  std::array<int, 4> outcomes{};
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d point(rng.uniform(0, 3.2), rng.uniform(0, 3.2), rng.uniform(0, 3.2));
    const double reach = rng.uniform(0.1, 2.5);
    const GroundBelow ours = groundBelow(*frozen, point, reach);
    const GroundBelow in_window = groundBelow(window, point, reach);
    EXPECT_EQ(ours.status, in_window.status);
    EXPECT_EQ(ours.z, in_window.z);
    GroundSearch expected = GroundSearch::kTooFar;
    double ground = 0.0;
    for (double z = point.z(); z >= point.z() - reach; z -= 0.0005) {  // down in small steps
      const map::Occupancy occupancy = frozen->at(Eigen::Vector3d(point.x(), point.y(), z));
      if (occupancy == map::Occupancy::kFree) continue;
      expected = occupancy == map::Occupancy::kUnknown ? GroundSearch::kUnknown
                 : z == point.z()                      ? GroundSearch::kInOccupied
                                                       : GroundSearch::kFound;
      ground = z;
      break;
    }
    EXPECT_EQ(ours.status, expected) << point.transpose() << " reach " << reach;
    if (expected == GroundSearch::kFound) {
      EXPECT_NEAR(ours.z, ground, 0.001);
    }
    ++outcomes[static_cast<std::size_t>(ours.status)];
  }
  for (const int count : outcomes) EXPECT_GT(count, 50);
}

TEST(GroundProjection, ReachCountsToTheTopOfTheGround) {
  map::MapParams params;
  params.range_min_m = 0.0;
  map::OccupancyMap world(params);
  world.markFree({{0.0, 0.0, 0.2}, {0.2, 0.2, 2.0}});
  map::occupy(world, {0, 0, 0});
  const auto frozen = world.freeze();
  EXPECT_EQ(groundBelow(*frozen, {0.1, 0.1, 1.2}, 0.95).status, GroundSearch::kTooFar);
  const GroundBelow found = groundBelow(*frozen, {0.1, 0.1, 1.2}, 1.05);
  EXPECT_EQ(found.status, GroundSearch::kFound);
  EXPECT_NEAR(found.z, 0.2, 1e-12);
}

TEST(GroundProjection, RefusesWhatIsNoPlace) {
  map::OccupancyMap world{map::MapParams{}};
  const auto frozen = world.freeze();
  EXPECT_THROW((void)groundBelow(*frozen, {std::nan(""), 0, 0}, 1.0), Precondition);
  EXPECT_THROW((void)groundBelow(*frozen, {0, 0, 0}, -1.0), Precondition);
  EXPECT_EQ(groundBelow(*frozen, {0, 0, 0}, 1.0).status, GroundSearch::kUnknown);
}

TEST(GroundProjection, InclinationIsSignedAndDefinedForOnePlace) {
  EXPECT_NEAR(inclination({0, 0, 0}, {3, 4, 5}), M_PI / 4.0, 1e-12);
  EXPECT_NEAR(inclination({0, 0, 1}, {1, 0, 0}), -M_PI / 4.0, 1e-12);
  EXPECT_EQ(inclination({1, 2, 3}, {1, 2, 3}), 0.0);
  EXPECT_NEAR(inclination({1, 2, 3}, {1, 2, 4}), M_PI / 2.0, 1e-12);
}

}  // namespace
}  // namespace spelunk::terrain
