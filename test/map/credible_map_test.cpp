#include "spelunk/map/credible_map.h"

#include <gtest/gtest.h>

#include <vector>

#include "map/block_map.h"
#include "map/frozen_blocks.h"
#include "spelunk/common/rng.h"

namespace spelunk::map {
namespace {

constexpr int kNx = 70;  // more than two chunks
constexpr int kNy = 40;
constexpr int kNz = 26;
const VoxelIndex kCorner(-37, -9, -11);  // chunks begin at multiples of 32

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

template <class Visit>
void forEachCell(Visit&& visit) {
  for (int z = 0; z < kNz; ++z)
    for (int y = 0; y < kNy; ++y)
      for (int x = 0; x < kNx; ++x) visit(x, y, z);
}

/// A map that grows: known voxels change or are added, none is forgotten.
class GrowingMap {
 public:
  std::shared_ptr<const FrozenMap> set(Grid grid) {
    forEachCell([&](int x, int y, int z) {
      const std::uint8_t cell = grid.at(x, y, z);
      if (cell != 0)
        blocks_.setValue(packIndex(kCorner + VoxelIndex(x, y, z)), cell == 2 ? 1.0F : -1.0F);
    });
    return freeze();
  }
  /// Looks in vain into all that `grid` marks, as often as makes it silent.
  std::shared_ptr<const FrozenMap> lookInVain(Grid grid) {
    for (int look = 0; look < SilentVoxels::kLooks; ++look) {
      std::vector<PackedKey> voxels;
      forEachCell([&](int x, int y, int z) {
        if (grid.at(x, y, z) != 0) voxels.push_back(packIndex(kCorner + VoxelIndex(x, y, z)));
      });
      silence_.countLook(voxels);
    }
    return freeze();
  }

 private:
  std::shared_ptr<const FrozenMap> freeze() {
    const FrozenMap::Blocks nothing;
    const FrozenMap::Blocks& last = frozen_ ? frozen_->blocks() : nothing;
    frozen_ = std::make_shared<const FrozenMap>(
        freezeBlocks(blocks_, silence_, {blocks_.takeStatusChanges(), silence_.takeChanges()},
                     last),
        0.2);
    return frozen_;
  }

  BlockMap blocks_{LogOdds(MapParams{})};
  SilentVoxels silence_;
  std::shared_ptr<const FrozenMap> frozen_;
};

/// Gaps between two voxels that are known or silent: free beside a free one, else solid.
void closeColumn(Grid& grid, Grid& silent, int x, int y, int gap_max) {
  int below = -1;
  for (int z = 0; z < kNz; ++z) {
    if (grid.at(x, y, z) == 0 && silent.at(x, y, z) == 0) continue;
    const int gap = z - below - 1;
    if (below >= 0 && gap > 0 && gap <= gap_max) {
      const bool is_free = grid.at(x, y, z) == 1 || grid.at(x, y, below) == 1;
      for (int k = below + 1; k < z; ++k) grid.at(x, y, k) = is_free ? 1 : 2;
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

Grid byBruteForce(Grid grid, int gap, int reach, Grid silent = {}) {
  for (int y = 0; y < kNy; ++y)
    for (int x = 0; x < kNx; ++x) closeColumn(grid, silent, x, y, gap);
  Grid grown = grid;
  forEachCell([&](int x, int y, int z) {
    if (isNearOccupied(grid, x, y, z, reach)) grown.at(x, y, z) = 2;
  });
  return grown;
}

/// Unknown voxels that are silent, or lie between two such in a column.
Grid closedSilence(Grid known, Grid silent, int gap_max) {
  forEachCell([&](int x, int y, int z) {
    if (known.at(x, y, z) != 0) silent.at(x, y, z) = 0;
  });
  Grid closed = silent;
  for (int y = 0; y < kNy; ++y)
    for (int x = 0; x < kNx; ++x)
      for (int z = 0, below = -1; z < kNz; ++z) {
        if (silent.at(x, y, z) == 0) continue;
        for (int k = below + 1; below >= 0 && z - below - 1 <= gap_max && k < z; ++k)
          if (known.at(x, y, k) == 0) closed.at(x, y, k) = 1;
        below = z;
      }
  return closed;
}

/// What silence adds: unknown voxels near silent ones are solid.
Grid endedAtSilence(Grid silent, Grid expected, int reach) {
  forEachCell([&](int x, int y, int z) { silent.at(x, y, z) *= 2; });
  forEachCell([&](int x, int y, int z) {
    if (expected.at(x, y, z) == 0 && isNearOccupied(silent, x, y, z, reach))
      expected.at(x, y, z) = 2;
  });
  return expected;
}

/// A free block with ragged ends in unknown space, and a few returns.
Grid drawGrid(Rng& rng) {
  Grid grid;
  for (int z = 2; z < 21; ++z)
    for (int y = 2; y < 36; ++y)
      for (int x = 3 + rng.below(3); x < 60 + rng.below(8); ++x)
        grid.at(x, y, z) = rng.below(3) == 0 ? 0 : 1;
  for (int i = 0; i < 60; ++i) grid.at(rng.below(kNx), rng.below(kNy), rng.below(kNz)) = 2;
  return grid;
}

void expectEqual(const FrozenMap& credible, Grid expected) {
  int different = 0;
  forEachCell([&](int x, int y, int z) {
    const auto got = credible.at(VoxelIndex(kCorner + VoxelIndex(x, y, z)));
    different += static_cast<std::uint8_t>(got) != expected.at(x, y, z) ? 1 : 0;
  });
  EXPECT_EQ(different, 0);
}

TEST(CredibleMap, AgreesWithLookingAtEachVoxel) {
  Rng rng(21);
  for (int round = 0; round < 4; ++round) {
    const Grid grid = drawGrid(rng);
    CredibleMap credible({1.4, 0.4});
    expectEqual(*credible.of(GrowingMap{}.set(grid)), byBruteForce(grid, 7, 2));
  }
}

TEST(CredibleMap, OfAChangedMapIsThatOfAFreshOne) {
  Rng rng(5);
  GrowingMap map;
  CredibleMap credible({1.4, 0.4});
  Grid grid;
  for (int round = 0; round < 6; ++round) {
    for (int i = 0; i < 900; ++i)
      grid.at(rng.below(kNx), rng.below(1 + 7 * round), rng.below(kNz)) =
          static_cast<std::uint8_t>(1 + rng.below(2));
    expectEqual(*credible.of(map.set(grid)), byBruteForce(grid, 7, 2));
  }
}

TEST(CredibleMap, SilentVoxelsEndRaysUntilTheyAreKnown) {
  Rng rng(34);
  GrowingMap map;
  CredibleMap credible({1.4, 0.4});
  Grid grid;
  Grid silent;
  for (int round = 0; round < 6; ++round) {
    for (int i = 0; i < 500; ++i)
      grid.at(rng.below(kNx), rng.below(1 + 7 * round), rng.below(kNz)) =
          static_cast<std::uint8_t>(1 + rng.below(4) / 3);
    static_cast<void>(credible.of(map.set(grid)));
    for (int i = 0; i < 200; ++i) silent.at(rng.below(kNx), rng.below(kNy), rng.below(kNz)) = 1;
    const Grid closed = closedSilence(grid, silent, 7);
    expectEqual(*credible.of(map.lookInVain(silent)),
                endedAtSilence(closed, byBruteForce(grid, 7, 2, closed), 2));
  }
}

TEST(CredibleMap, StartsAnewOnAnotherMap) {
  Rng rng(8);
  CredibleMap credible({1.4, 0.2});
  static_cast<void>(credible.of(GrowingMap{}.set(drawGrid(rng))));
  Grid grid;
  grid.at(1, 1, 1) = 2;
  expectEqual(*credible.of(GrowingMap{}.set(grid)), byBruteForce(grid, 7, 1));
}

TEST(CredibleMap, CountsItsVoxels) {
  Rng rng(9);
  GrowingMap map;
  CredibleMap credible({1.4, 0.0});
  for (int round = 0; round < 3; ++round) {
    const auto view = credible.of(map.set(drawGrid(rng)));
    std::size_t free = 0;
    std::size_t occupied = 0;
    forEachCell([&](int x, int y, int z) {
      const Occupancy status = view->at(VoxelIndex(kCorner + VoxelIndex(x, y, z)));
      free += status == Occupancy::kFree ? 1 : 0;
      occupied += status == Occupancy::kOccupied ? 1 : 0;
    });
    EXPECT_EQ(view->freeVoxels(), free);
    EXPECT_EQ(view->occupiedVoxels(), occupied);
  }
}

TEST(CredibleMap, ClosesGapsBetweenRowsOfAFarWall) {
  Grid grid;
  grid.at(5, 5, 2) = grid.at(5, 5, 7) = 2;
  CredibleMap credible({1.4, 0.4});
  const auto view = credible.of(GrowingMap{}.set(grid));
  for (int z = 2; z <= 7; ++z)
    EXPECT_EQ(view->at(VoxelIndex(kCorner + VoxelIndex(5, 5, z))), Occupancy::kOccupied);
}

TEST(CredibleMap, ShutsAHoleInAWallAndKeepsTheOpenEndOfAGallery) {
  Grid grid;
  for (int z = 3; z < 11; ++z)
    for (int y = 2; y < 10; ++y)
      for (int x = 0; x < 40; ++x) grid.at(x, y, z) = y == 9 ? 2 : 1;
  grid.at(20, 9, 6) = 0;
  CredibleMap credible({1.4, 0.2});
  const auto view = credible.of(GrowingMap{}.set(grid));
  const auto at = [&](int x, int y, int z) {
    return view->at(VoxelIndex(kCorner + VoxelIndex(x, y, z)));
  };
  EXPECT_EQ(at(20, 9, 6), Occupancy::kOccupied);
  EXPECT_EQ(at(40, 6, 6), Occupancy::kUnknown);
  EXPECT_EQ(at(39, 6, 6), Occupancy::kFree);
}

}  // namespace
}  // namespace spelunk::map
