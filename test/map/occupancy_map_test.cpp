#include "spelunk/map/occupancy_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scan scanOf(const Eigen::Vector3d& origin, const std::vector<Eigen::Vector3f>& points) {
  Scan scan;
  scan.T_world_sensor.translate(origin);
  scan.points = points;
  return scan;
}

TEST(OccupancyMap, RayIsFreeAndItsEndOccupied) {
  OccupancyMap map{MapParams{}};
  const MapUpdate update = map.insert(scanOf({0.1, 0.1, 0.1}, {{2.0F, 0.0F, 0.0F}}), noBody());
  EXPECT_EQ(map.at({0.1, 0.1, 0.1}), Occupancy::kFree);
  EXPECT_EQ(map.at({1.9, 0.1, 0.1}), Occupancy::kFree);
  EXPECT_EQ(map.at({2.1, 0.1, 0.1}), Occupancy::kOccupied);
  EXPECT_EQ(map.at({2.3, 0.1, 0.1}), Occupancy::kUnknown);
  EXPECT_EQ(update.points, 1);
  EXPECT_EQ(update.voxels_updated, 11);
  EXPECT_EQ(update.voxels_changed_status, 11);
  ASSERT_EQ(update.newly_occupied.size(), 1u);
  EXPECT_EQ(update.newly_occupied[0], VoxelIndex(10, 0, 0));
  EXPECT_TRUE(update.changed.min.isApprox(Eigen::Vector3d::Zero(), 1e-12));
  EXPECT_TRUE(update.changed.max.isApprox(Eigen::Vector3d(2.2, 0.2, 0.2), 1e-12));
}

TEST(OccupancyMap, ReportsOnlyWhatChanges) {
  MapParams params;
  params.hit_probability = 0.7;
  params.miss_probability = 0.4;
  OccupancyMap map(params);
  const Scan scan = scanOf({0.1, 0.1, 0.1}, {{2.0F, 0.0F, 0.0F}});
  map.insert(scan, noBody());
  const MapUpdate again = map.insert(scan, noBody());
  EXPECT_EQ(again.voxels_updated, 11);
  EXPECT_EQ(again.voxels_changed_status, 0);
  EXPECT_TRUE(again.newly_occupied.empty());
  EXPECT_TRUE(again.changed.isEmpty());
  const Scan longer = scanOf({0.1, 0.1, 0.1}, {{3.0F, 0.0F, 0.0F}});
  MapUpdate last;
  for (int i = 0; i < 6; ++i) last = map.insert(longer, noBody());
  EXPECT_EQ(map.at({2.1, 0.1, 0.1}), Occupancy::kFree) << "misses outvote the two hits";
}

TEST(OccupancyMap, OccupiedWinsWithinAScan) {
  MapParams params;
  params.discretize = false;
  OccupancyMap map(params);
  map.insert(scanOf({0.1, 0.1, 0.1}, {{2.0F, 0.0F, 0.0F}, {4.0F, 0.0F, 0.0F}}), noBody());
  EXPECT_EQ(map.at({2.1, 0.1, 0.1}), Occupancy::kOccupied);
}

TEST(OccupancyMap, LongReturnsOnlyFreeTheirRayUpToTheRange) {
  MapParams params;
  params.range_max_m = 5.0;
  OccupancyMap map(params);
  const MapUpdate update =
      map.insert(scanOf({0.1, 0.1, 0.1}, {{9.0F, 0.0F, 0.0F}, {0.0F, 1e4F, 0.0F}}), noBody());
  EXPECT_EQ(map.at({4.7, 0.1, 0.1}), Occupancy::kFree);
  EXPECT_EQ(map.at({5.5, 0.1, 0.1}), Occupancy::kUnknown);
  EXPECT_EQ(map.freeze()->occupiedVoxels(), 0u);
  EXPECT_EQ(update.dropped_far, 1) << "10 km is beyond what a key can hold";
}

TEST(OccupancyMap, PointBeyondTheRangeDoesNotWipeAHitInItsVoxel) {
  MapParams params;
  params.range_max_m = 5.0;
  params.discretize = false;
  const Eigen::Vector3f within(4.95F, 0.0F, 0.0F);
  const Eigen::Vector3f beyond(5.05F, 0.0F, 0.0F);
  for (const auto& points : {std::vector{within, beyond}, std::vector{beyond, within}}) {
    OccupancyMap map(params);
    map.insert(scanOf({0.1, 0.1, 0.1}, points), noBody());
    EXPECT_EQ(map.at({5.1, 0.1, 0.1}), Occupancy::kOccupied);
  }
  OccupancyMap map(params);
  map.insert(scanOf({0.1, 0.1, 0.1}, {beyond}), noBody());
  EXPECT_NE(map.at({5.1, 0.1, 0.1}), Occupancy::kOccupied);
}

TEST(OccupancyMap, OddPointsAreDroppedAndCounted) {
  for (const bool discretize : {false, true}) {
    MapParams params;
    params.discretize = discretize;
    OccupancyMap map(params);
    const AxisAlignedBox body = boxAround({0.1, 0.1, 0.1}, {1.2, 1.2, 1.2});
    const MapUpdate update = map.insert(scanOf({0.1, 0.1, 0.1}, {{kNan, 0.0F, 0.0F},
                                                                 {0.0F, kInfinity, 0.0F},
                                                                 {0.0F, 0.0F, 0.0F},
                                                                 {0.3F, 0.0F, 0.0F},
                                                                 {0.5F, 0.0F, 0.0F},
                                                                 {3e38F, 3e38F, 3e38F},
                                                                 {-6600.0F, 0.0F, 0.0F},
                                                                 {0.0F, 2.0F, 0.0F}}),
                                        body);
    EXPECT_EQ(update.points, 8);
    EXPECT_EQ(update.dropped_not_finite, 2);
    EXPECT_EQ(update.dropped_near, 2);
    EXPECT_EQ(update.dropped_self, 1);
    EXPECT_EQ(update.dropped_far, 2);
    EXPECT_EQ(map.freeze()->occupiedVoxels(), 1u);
    EXPECT_EQ(map.at({0.1, 2.1, 0.1}), Occupancy::kOccupied);
  }
}

TEST(OccupancyMap, EmptyScanAndScanFromFarAwayChangeNothing) {
  OccupancyMap map{MapParams{}};
  EXPECT_TRUE(map.insert(Scan{}, noBody()).changed.isEmpty());
  const MapUpdate far = map.insert(scanOf({1e7, 0.0, 0.0}, {{2.0F, 0.0F, 0.0F}}), noBody());
  EXPECT_EQ(far.dropped_far, 1);
  EXPECT_TRUE(map.freeze()->knownBounds().isEmpty());
}

TEST(OccupancyMap, SurvivesRaysAtTheRimOfTheKeyRange) {
  OccupancyMap map{MapParams{}};
  const double rim = 32759.0 * 0.2;
  Rng rng(8);
  for (int i = 0; i < 200; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    std::vector<Eigen::Vector3f> points;
    for (int k = 0; k < 20; ++k)
      points.emplace_back(static_cast<float>(rng.uniform(-9, 9)),
                          static_cast<float>(rng.uniform(-9, 9)),
                          static_cast<float>(rng.uniform(-9, 9)));
    map.insert(scanOf({side * rim, -side * rim, rng.uniform(-1, 1)}, points), noBody());
  }
  EXPECT_GT(map.freeze()->occupiedVoxels(), 0u);
  EXPECT_EQ(map.at({1e30, 0.0, 0.0}), Occupancy::kUnknown);
  EXPECT_EQ(map.at({kNan, 0.0, 0.0}), Occupancy::kUnknown);
}

TEST(OccupancyMap, PoseThatIsNotFiniteBreaksTheContract) {
  OccupancyMap map{MapParams{}};
  EXPECT_THROW(map.insert(scanOf({kNan, 0.0, 0.0}, {{2.0F, 0.0F, 0.0F}}), noBody()), Precondition);
  EXPECT_THROW(map.markFree({{0.0, 0.0, 0.0}, {1.0, 1.0, kInfinity}}), Precondition);
  MapParams params;
  params.clamp_max_probability = 1.0;
  EXPECT_THROW(OccupancyMap{params}, Precondition);
}

TEST(OccupancyMap, MarkFreeFreesUnknownVoxelsOnly) {
  OccupancyMap map{MapParams{}};
  map.insert(scanOf({0.1, 0.1, 0.1}, {{2.0F, 0.0F, 0.0F}}), noBody());
  map.markFree(boxAround({2.1, 0.1, 0.1}, {0.6, 0.6, 0.6}));
  EXPECT_EQ(map.at({2.1, 0.1, 0.1}), Occupancy::kOccupied);
  EXPECT_EQ(map.at({2.3, 0.3, -0.1}), Occupancy::kFree);
  EXPECT_EQ(map.at({2.5, 0.1, 0.1}), Occupancy::kUnknown) << "a box that ends on a face";
  EXPECT_EQ(map.octree().search(2.3, 0.3, -0.1)->getLogOdds(),
            octomap::logodds(MapParams{}.miss_probability));
}

TEST(OccupancyMap, MarkFreeHoldsEvenIfOneMissIsNotEnough) {
  MapParams params;
  params.occupied_probability = 0.3;
  OccupancyMap map(params);
  map.markFree(boxAround({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}));
  EXPECT_EQ(map.at({0.1, 0.1, 0.1}), Occupancy::kFree);
}

TEST(OccupancyMap, SameScansGiveSameUpdatesInOrder) {
  Rng rng_a(12);
  Rng rng_b(12);
  OccupancyMap a{MapParams{}};
  OccupancyMap b{MapParams{}};
  for (int i = 0; i < 5; ++i) {
    const MapUpdate from_a = a.insert(hallScan(rng_a, hallPosition(i), 500), noBody());
    const MapUpdate from_b = b.insert(hallScan(rng_b, hallPosition(i), 500), noBody());
    EXPECT_NE(b.freeze(), nullptr);
    EXPECT_EQ(from_a.newly_occupied, from_b.newly_occupied);
    EXPECT_EQ(from_a.voxels_updated, from_b.voxels_updated);
  }
}

TEST(OccupancyMap, ClearForgetsEverything) {
  OccupancyMap map = hallMap(MapParams{}, 2, 200, 1);
  const auto before = map.freeze();
  EXPECT_GT(map.octree().size(), 0u);
  map.clear();
  EXPECT_EQ(map.freeze()->freeVoxels(), 0u);
  EXPECT_EQ(map.octree().size(), 0u);
  EXPECT_GT(before->freeVoxels(), 0u);
}

TEST(OccupancyMap, TakesLessMemoryThanTheOcTree) {
  Rng rng(2);
  OccupancyMap map{MapParams{}};
  for (int i = 0; i < 24; ++i) map.insert(hallScan(rng, hallPosition(i), 3000), noBody());
  EXPECT_GT(map.memoryBytes(), 100000u);
  EXPECT_LT(map.memoryBytes(), map.octree().memoryUsage());
}

}  // namespace
}  // namespace spelunk::map
