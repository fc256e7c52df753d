#include <gtest/gtest.h>

#include "map_worlds.h"

namespace spelunk::map {
namespace {

struct NodeCount {
  std::size_t nodes = 0;
  std::size_t different = 0;
};

/// Walks both trees side by side: existence of children and the value of every node.
void compare(const octomap::OcTree& a, const octomap::OcTreeNode* in_a, const octomap::OcTree& b,
             const octomap::OcTreeNode* in_b, NodeCount& count) {
  ++count.nodes;
  if (in_a->getLogOdds() != in_b->getLogOdds()) ++count.different;
  for (unsigned i = 0; i < 8; ++i) {
    if (a.nodeChildExists(in_a, i) != b.nodeChildExists(in_b, i)) {
      ++count.different;
    } else if (a.nodeChildExists(in_a, i)) {
      compare(a, a.getNodeChild(in_a, i), b, b.getNodeChild(in_b, i), count);
    }
  }
}

void expectIdentical(const octomap::OcTree& ours, const octomap::OcTree& plain) {
  ASSERT_NE(ours.getRoot(), nullptr);
  NodeCount count;
  compare(ours, ours.getRoot(), plain, plain.getRoot(), count);
  EXPECT_EQ(count.different, 0u) << "of " << count.nodes << " nodes";
  EXPECT_EQ(count.nodes, plain.size());
  EXPECT_EQ(ours.size(), plain.size());
  EXPECT_TRUE(ours == plain);
}

struct Setting {
  double resolution_m;
  bool discretize;
  double range_max_m;
};

class OcTreeIdentity : public testing::TestWithParam<Setting> {};

TEST_P(OcTreeIdentity, HoldsForMovingSensorScanByScan) {
  MapParams params;
  params.resolution_m = GetParam().resolution_m;
  params.discretize = GetParam().discretize;
  params.range_max_m = GetParam().range_max_m;
  params.range_min_m = 0.0;
  Rng rng(11);
  OccupancyMap map(params);
  octomap::OcTree plain = emptyTree(params);
  for (int i = 0; i < 24; ++i) {
    // Standing still every other time lets voxels clamp, prune and expand again.
    const Scan scan = hallScan(rng, hallPosition(i - i % 2), 700);
    map.insert(scan, noBody());
    insertPlainly(plain, scan, params);
    if (i % 5 == 4) expectIdentical(map.octree(), plain);  // several scans in one go
  }
  expectIdentical(map.octree(), plain);
}

INSTANTIATE_TEST_SUITE_P(Settings, OcTreeIdentity,
                         testing::Values(Setting{0.2, true, 50.0}, Setting{0.2, false, 50.0},
                                         Setting{0.1, true, 50.0}, Setting{0.1, false, 50.0},
                                         Setting{0.2, true, 5.0}, Setting{0.2, false, 5.0},
                                         Setting{0.37, false, 6.1}));

TEST(OcTreeIdentity, HoldsWhereSpaceSaturatesAndPrunes) {
  MapParams params;
  params.range_min_m = 0.0;
  Rng rng(5);
  OccupancyMap map(params);
  octomap::OcTree plain = emptyTree(params);
  for (int i = 0; i < 12; ++i) {
    const Scan scan = hallScan(rng, hallPosition(3), 6000);
    map.insert(scan, noBody());
    insertPlainly(plain, scan, params);
    expectIdentical(map.octree(), plain);
  }
  std::size_t pruned = 0;
  for (auto leaf = plain.begin_leafs(); leaf != plain.end_leafs(); ++leaf)
    if (leaf.getDepth() < 16) ++pruned;
  EXPECT_GT(pruned, 200u);
}

TEST(OcTreeIdentity, HoldsWithOtherProbabilities) {
  MapParams params;
  params.range_min_m = 0.0;
  params.hit_probability = 0.9;
  params.miss_probability = 0.45;
  params.clamp_min_probability = 0.3;
  params.clamp_max_probability = 0.8;
  params.occupied_probability = 0.6;
  Rng rng(6);
  OccupancyMap map(params);
  octomap::OcTree plain = emptyTree(params);
  for (int i = 0; i < 10; ++i) {
    const Scan scan = hallScan(rng, hallPosition(i), 500);
    map.insert(scan, noBody());
    insertPlainly(plain, scan, params);
  }
  expectIdentical(map.octree(), plain);
}

TEST(OcTreeIdentity, HoldsForRaysAlongAxesAndDiagonals) {
  MapParams params;
  params.range_min_m = 0.0;
  for (const bool discretize : {false, true}) {
    params.discretize = discretize;
    OccupancyMap map(params);
    octomap::OcTree plain = emptyTree(params);
    for (const double start : {0.1, 0.2, 0.0}) {
      Scan scan;
      scan.T_world_sensor.translate(Eigen::Vector3d(start, start, start));
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -1; z <= 1; ++z)
            scan.points.push_back(3.0F * VoxelIndex(x, y, z).cast<float>());
      scan.points.erase(scan.points.begin() + 13);  // range 0, which the map drops
      map.insert(scan, noBody());
      insertPlainly(plain, scan, params);
    }
    expectIdentical(map.octree(), plain);
  }
}

TEST(OcTreeIdentity, StatusEqualsOctoMapsEverywhere) {
  MapParams params;
  params.range_min_m = 0.0;
  Rng rng(3);
  OccupancyMap map(params);
  octomap::OcTree plain = emptyTree(params);
  for (int i = 0; i < 10; ++i) {
    const Scan scan = hallScan(rng, hallPosition(i), 800);
    map.insert(scan, noBody());
    insertPlainly(plain, scan, params);
  }
  const auto frozen = map.freeze();
  std::size_t free = 0;
  std::size_t occupied = 0;
  for (int x = -60; x < 70; ++x)
    for (int y = -40; y < 40; ++y)
      for (int z = -12; z < 24; ++z) {
        const Occupancy wanted = statusIn(plain, {x, y, z});
        ASSERT_EQ(frozen->at(VoxelIndex(x, y, z)), wanted);
        ASSERT_EQ(map.at(frozen->centreOf({x, y, z})), wanted);
        free += wanted == Occupancy::kFree ? 1 : 0;
        occupied += wanted == Occupancy::kOccupied ? 1 : 0;
      }
  EXPECT_EQ(frozen->freeVoxels(), free);
  EXPECT_EQ(frozen->occupiedVoxels(), occupied);
  EXPECT_GT(occupied, 500u);
}

}  // namespace
}  // namespace spelunk::map
