#include "spelunk/map/presumed_ways.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <vector>

#include "map/block_map.h"
#include "map/frozen_blocks.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::map {
namespace {

constexpr double kEdge_m = 0.2;
constexpr double kCell_m = 4.0 * kEdge_m;
constexpr double kFar_m = 1000.0;

/// A map made voxel by voxel.
class Painted {
 public:
  void fill(const VoxelIndex& min, const VoxelIndex& max, Occupancy status) {
    for (int z = min.z(); z <= max.z(); ++z)
      for (int y = min.y(); y <= max.y(); ++y)
        for (int x = min.x(); x <= max.x(); ++x)
          blocks_.setValue(packIndex({x, y, z}), status == Occupancy::kOccupied ? 1.0F : -1.0F);
  }
  std::shared_ptr<const FrozenMap> frozen() {
    return std::make_shared<const FrozenMap>(
        freezeBlocks(blocks_, SilentVoxels{}, {blocks_.takeStatusChanges(), {}},
                     FrozenMap::Blocks{}),
        kEdge_m);
  }

 private:
  BlockMap blocks_{LogOdds(MapParams{})};
};

Eigen::Vector3d inCell(int x, int y, int z) {
  return kCell_m * (Eigen::Vector3d(x, y, z).array() + 0.5);
}

/// A ring of galleries around rock: 20 x 12 cells, galleries two cells wide and high.
Painted ring() {
  Painted map;
  map.fill({-40, -24, 0}, {39, 23, 7}, Occupancy::kFree);
  map.fill({-32, -16, 0}, {31, 15, 7}, Occupancy::kOccupied);
  return map;
}

double lengthOf(const std::vector<Eigen::Vector3d>& way) {
  double sum = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += (way[i] - way[i - 1]).norm();
  return sum;
}

TEST(PresumedWays, LeadRoundTheRockWhereSpaceWasSeenOpen) {
  const auto map = ring().frozen();
  const Eigen::Vector3d from = inCell(0, -5, 0);
  const Eigen::Vector3d behind = inCell(0, 5, 0);
  const PresumedWays ways(map, from, kFar_m);
  // Half the ring at least: 10 + 10 + 10 cells, corners cut.
  EXPECT_GT(ways.distanceTo(behind), 24.0 * kCell_m);
  EXPECT_LT(ways.distanceTo(behind), 30.0 * kCell_m);
  const auto way = ways.wayTo(behind);
  EXPECT_NEAR(lengthOf(way), ways.distanceTo(behind), 1e-3);
  EXPECT_LT((way.front() - from).norm(), 1e-9);
  EXPECT_LT((way.back() - behind).norm(), 1e-9);
  for (const Eigen::Vector3d& at : way) EXPECT_EQ(map->at(at), Occupancy::kFree);
  for (std::size_t i = 1; i < way.size(); ++i)
    EXPECT_LT((way[i] - way[i - 1]).norm(), 1.8 * kCell_m);
}

TEST(PresumedWays, GoTheOtherWayRoundAClosedPlaceAndNoneRoundTwo) {
  const auto map = ring().frozen();
  const Eigen::Vector3d from = inCell(-3, -5, 0);
  const Eigen::Vector3d behind = inCell(-3, 5, 0);
  const ClosedPlace west{inCell(-9, 0, 0), 3.0 * kCell_m};
  const ClosedPlace east{inCell(9, 0, 0), 3.0 * kCell_m};
  const double open = PresumedWays(map, from, kFar_m).distanceTo(behind);
  const double round = PresumedWays(map, from, kFar_m, {west}).distanceTo(behind);
  EXPECT_GT(round, open + 5.0 * kCell_m);
  EXPECT_TRUE(std::isfinite(round));
  const PresumedWays closed(map, from, kFar_m, {west, east});
  EXPECT_FALSE(std::isfinite(closed.distanceTo(behind)));
  EXPECT_TRUE(closed.wayTo(behind).empty());
}

TEST(PresumedWays, LookNoFartherThanAsked) {
  const auto map = ring().frozen();
  const PresumedWays ways(map, inCell(0, -5, 0), 5.0);
  EXPECT_TRUE(std::isfinite(ways.distanceTo(inCell(4, -5, 0))));
  EXPECT_FALSE(std::isfinite(ways.distanceTo(inCell(9, -5, 0))));
}

TEST(PresumedWays, NeedAQuarterOfACell) {
  for (const int thickness : {1, 2}) {  // voxels of a layer a cell wide
    Painted map;
    map.fill({0, 0, 0}, {3, 3, 3}, Occupancy::kFree);
    map.fill({4, 0, 0}, {15, 3, thickness - 1}, Occupancy::kFree);
    map.fill({16, 0, 0}, {19, 3, 3}, Occupancy::kFree);
    map.fill({4, 0, 0}, {15, 0, 0}, Occupancy::kOccupied);  // leaves 12 or 28 of 64
    const PresumedWays ways(map.frozen(), inCell(0, 0, 0), kFar_m);
    EXPECT_EQ(std::isfinite(ways.distanceTo(inCell(4, 0, 0))), thickness == 2) << thickness;
  }
}

TEST(PresumedWays, KnowNothingOfPlacesNeverSeen) {
  const PresumedWays ways(ring().frozen(), inCell(0, -5, 0), kFar_m);
  EXPECT_FALSE(std::isfinite(ways.distanceTo({500.0, 0.0, 0.0})));
  EXPECT_FALSE(std::isfinite(ways.distanceTo({1e9, 0.0, 0.0})));
  EXPECT_THROW(PresumedWays(nullptr, Eigen::Vector3d::Zero(), 1.0), Precondition);
}

/// Plain Dijkstra over the same cells, looked up voxel by voxel.
class BruteForce {
 public:
  BruteForce(std::shared_ptr<const FrozenMap> map, const VoxelIndex& from) : map_(std::move(map)) {
    using Entry = std::pair<double, std::array<int, 3>>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    open.push({0.0, {from.x(), from.y(), from.z()}});
    while (!open.empty()) {
      const auto [length, cell] = open.top();
      open.pop();
      if (!lengths_.insert({cell, length}).second) continue;
      for (int k = 0; k < 27; ++k) {
        const std::array<int, 3> step{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        const std::array<int, 3> next{cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]};
        if (!isOpen(next)) continue;
        open.push(
            {length + std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]), next});
      }
    }
  }
  [[nodiscard]] double lengthTo(int x, int y, int z) const {
    const auto found = lengths_.find({x, y, z});
    return found == lengths_.end() ? -1.0 : found->second * kCell_m;
  }

 private:
  [[nodiscard]] bool isOpen(const std::array<int, 3>& cell) const {
    int free = 0;
    for (int k = 0; k < 64; ++k) {
      const VoxelIndex voxel(4 * cell[0] + k % 4, 4 * cell[1] + k / 4 % 4, 4 * cell[2] + k / 16);
      free += map_->at(voxel) == Occupancy::kFree ? 1 : 0;
    }
    return free >= 16;
  }
  std::shared_ptr<const FrozenMap> map_;
  std::map<std::array<int, 3>, double> lengths_;
};

TEST(PresumedWays, AreAsShortAsPlainDijkstraSays) {
  Rng rng(5);
  Painted painted;
  for (int x = -12; x < 12; ++x)
    for (int y = -9; y < 9; ++y)
      for (int z = -3; z < 3; ++z) {
        if (rng.uniform(0.0, 1.0) < 0.55) continue;  // percolates barely: ways wind
        painted.fill({4 * x, 4 * y, 4 * z}, {4 * x + 3, 4 * y + 3, 4 * z + 3}, Occupancy::kFree);
      }
  painted.fill({0, 0, 0}, {3, 3, 3}, Occupancy::kFree);
  const auto map = painted.frozen();
  const PresumedWays ways(map, inCell(0, 0, 0), kFar_m);
  const BruteForce plain(map, {0, 0, 0});
  int reached = 0;
  for (int x = -12; x < 12; ++x)
    for (int y = -9; y < 9; ++y)
      for (int z = -3; z < 3; ++z) {
        const double expected = plain.lengthTo(x, y, z);
        if (expected < 0.0) continue;
        ++reached;
        EXPECT_NEAR(ways.distanceTo(inCell(x, y, z)), expected, 1e-3);
      }
  EXPECT_GT(reached, 500);
}

}  // namespace
}  // namespace spelunk::map
