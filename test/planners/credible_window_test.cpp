#include "spelunk/planners/gbplanner/credible_window.h"

#include <gtest/gtest.h>

#include <array>

#include "spelunk/common/rng.h"
#include "spelunk/map/occupancy_map.h"

namespace spelunk::planners::gbplanner {
namespace {

constexpr int kNx = 70;  // more than one word of bits
constexpr int kNy = 12;
constexpr int kNz = 14;

map::LocalWindow windowOf(const std::vector<std::uint8_t>& cells) {
  map::OccupancyMap map{map::MapParams{}};
  const map::LocalWindow empty(
      *map.freeze(), {{0.05, 0.05, 0.05}, {kNx * 0.2 - 0.05, kNy * 0.2 - 0.05, kNz * 0.2 - 0.05}});
  return empty.withCells(cells);
}

struct Grid {
  std::vector<std::uint8_t> cells = std::vector<std::uint8_t>(kNx * kNy * kNz, 0);
  static bool has(int x, int y, int z) {
    return x >= 0 && x < kNx && y >= 0 && y < kNy && z >= 0 && z < kNz;
  }
  std::uint8_t& at(int x, int y, int z) {
    return cells[static_cast<std::size_t>((z * kNy + y) * kNx + x)];
  }
  /// Outside: unknown.
  std::uint8_t get(int x, int y, int z) { return has(x, y, z) ? at(x, y, z) : std::uint8_t{0}; }
};

void closeColumn(Grid& grid, int x, int y, int gap_max) {
  int below = -1;
  for (int z = 0; z < kNz; ++z) {
    if (grid.at(x, y, z) == 0) continue;
    const int gap = z - below - 1;
    if (below >= 0 && gap > 0 && gap <= gap_max) {
      const bool solid = grid.at(x, y, z) == 2 && grid.at(x, y, below) == 2;
      for (int k = below + 1; k < z; ++k) grid.at(x, y, k) = solid ? 2 : 1;
    }
    below = z;
  }
}

bool isNearOccupied(Grid& grid, int x, int y, int z, int reach) {
  for (int k = -1; k <= 1; ++k)
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i)
        if (grid.get(x + i, y + j, z + k) == 2) return true;
  return false;
}

std::vector<std::uint8_t> byBruteForce(Grid grid, int gap, int reach) {
  for (int y = 0; y < kNy; ++y)
    for (int x = 0; x < kNx; ++x) closeColumn(grid, x, y, gap);
  Grid grown = grid;
  for (int z = 0; z < kNz; ++z)
    for (int y = 0; y < kNy; ++y)
      for (int x = 0; x < kNx; ++x)
        if (isNearOccupied(grid, x, y, z, reach)) grown.at(x, y, z) = 2;
  return grown.cells;
}

/// A free block with ragged ends in unknown space, and a few returns.
Grid drawGrid(Rng& rng) {
  Grid grid;
  for (int z = 2; z < 11; ++z)
    for (int y = 2; y < 10; ++y)
      for (int x = 3 + rng.below(3); x < 60 + rng.below(8); ++x)
        grid.at(x, y, z) = rng.below(12) == 0 ? 0 : 1;
  for (int i = 0; i < 25; ++i) grid.at(rng.below(kNx), rng.below(kNy), rng.below(kNz)) = 2;
  return grid;
}

TEST(CredibleWindow, AgreesWithLookingAtEachVoxel) {
  Rng rng(21);
  for (int round = 0; round < 8; ++round) {
    const Grid grid = drawGrid(rng);
    const map::LocalWindow credible = credibleWindow(windowOf(grid.cells), {1.4, 0.4});
    ASSERT_EQ(credible.cells(), byBruteForce(grid, 7, 2)) << "round " << round;
  }
}

TEST(CredibleWindow, ClosesGapsBetweenRowsOfAFarWall) {
  Grid grid;
  grid.at(5, 5, 2) = grid.at(5, 5, 7) = 2;
  const map::LocalWindow credible = credibleWindow(windowOf(grid.cells), {1.4, 0.4});
  for (int z = 2; z <= 7; ++z)
    EXPECT_EQ(credible.at(map::VoxelIndex(5, 5, z)), map::Occupancy::kOccupied);
}

TEST(CredibleWindow, ShutsAHoleInAWallAndKeepsTheOpenEndOfAGallery) {
  Grid grid;
  for (int z = 3; z < 11; ++z)
    for (int y = 2; y < 10; ++y)
      for (int x = 0; x < 40; ++x) grid.at(x, y, z) = y == 9 ? 2 : 1;
  grid.at(20, 9, 6) = 0;
  const map::LocalWindow credible = credibleWindow(windowOf(grid.cells), {1.4, 0.2});
  EXPECT_EQ(credible.at(map::VoxelIndex(20, 9, 6)), map::Occupancy::kOccupied);
  EXPECT_EQ(credible.at(map::VoxelIndex(40, 6, 6)), map::Occupancy::kUnknown);
  EXPECT_EQ(credible.at(map::VoxelIndex(39, 6, 6)), map::Occupancy::kFree);
}

}  // namespace
}  // namespace spelunk::planners::gbplanner
