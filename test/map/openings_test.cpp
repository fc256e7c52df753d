#include "spelunk/map/openings.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "map/block_map.h"
#include "map/frozen_blocks.h"
#include "spelunk/common/rng.h"

namespace spelunk::map {
namespace {

constexpr double kResolution = 0.2;
const Eigen::Vector3d kBox(1.1, 1.1, 0.4);

/// Free boxes with silent voxels beyond.
class OpenSpace {
 public:
  void carve(const VoxelIndex& first, const VoxelIndex& last) {
    forEach(first, last, [&](PackedKey voxel) { blocks_.setValue(voxel, -1.0F); });
  }
  void silence(const VoxelIndex& first, const VoxelIndex& last) {
    for (int look = 0; look < SilentVoxels::kLooks; ++look) {
      std::vector<PackedKey> voxels;
      forEach(first, last, [&](PackedKey voxel) { voxels.push_back(voxel); });
      silence_.countLook(voxels);
    }
  }
  [[nodiscard]] FrozenMap freeze() {
    return {freezeBlocks(blocks_, silence_, {blocks_.takeStatusChanges(), silence_.takeChanges()},
                         FrozenMap::Blocks{}),
            kResolution};
  }

 private:
  template <class Visit>
  static void forEach(const VoxelIndex& first, const VoxelIndex& last, Visit&& visit) {
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x) visit(packIndex(x, y, z));
  }
  BlockMap blocks_{LogOdds(MapParams{})};
  SilentVoxels silence_;
};

TEST(Openings, HaveThePlaceSizeAndDirectionOfAPortal) {
  OpenSpace space;
  space.carve({-50, 0, 0}, {39, 24, 16});
  space.silence({40, 0, 0}, {46, 24, 16});
  const auto openings = findOpenings(space.freeze(), kBox);
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].area_m2, 5.0 * 3.4, 1e-9);
  EXPECT_LT((openings[0].centre - Eigen::Vector3d(8.0, 2.5, 1.7)).norm(), 1e-9);
  EXPECT_LT((openings[0].outward - Eigen::Vector3d::UnitX()).norm(), 1e-9);
}

TEST(Openings, RaggedBordersHaveTheAreaOfTheOpening) {
  Rng rng(4);
  OpenSpace space;
  space.silence({30, 0, 0}, {46, 24, 16});
  for (int z = 0; z <= 16; ++z)
    for (int y = 0; y <= 24; ++y) space.carve({20, y, z}, {34 + rng.below(5), y, z});
  const auto openings = findOpenings(space.freeze(), kBox);
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].area_m2, 17.0, 1.0);
  EXPECT_GT(openings[0].outward.x(), 0.95);
}

TEST(Openings, LieAtTheRimOfTheBulgeThatKnownSpaceEndsIn) {
  OpenSpace space;
  space.silence({20, 0, 0}, {46, 24, 16});
  for (int z = 0; z <= 16; ++z)
    for (int y = 0; y <= 24; ++y) space.carve({10, y, z}, {28 + std::abs(y - 12), y, z});
  const auto openings = findOpenings(space.freeze(), kBox);
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].centre.x(), 8.2, 0.5);
  EXPECT_NEAR(openings[0].centre.y(), 2.5, 0.1);
}

TEST(Openings, OnesTheRobotDoesNotFitThroughAreNotNamed) {
  for (const int last_y : {7, 8}) {  // 1.0 or 1.2 m wide, 0.4 m high
    OpenSpace space;
    space.carve({0, 0, 0}, {39, 24, 16});
    space.silence({40, 3, 3}, {44, last_y, 4});
    EXPECT_EQ(findOpenings(space.freeze(), kBox).size(), last_y == 8 ? 1U : 0U);
  }
}

TEST(Openings, FarApartAreNamedOneByOneTheLargestFirst) {
  OpenSpace space;
  space.carve({0, 0, 0}, {39, 24, 16});
  space.silence({-5, 0, 0}, {-1, 9, 9});
  space.silence({40, 0, 0}, {44, 24, 16});
  const auto openings = findOpenings(space.freeze(), kBox);
  ASSERT_EQ(openings.size(), 2U);
  EXPECT_GT(openings[0].outward.x(), 0.99);
  EXPECT_LT(openings[1].outward.x(), -0.99);
  EXPECT_NEAR(openings[1].area_m2, 4.0, 1e-9);
}

TEST(Openings, AMapWithoutSilenceHasNone) {
  OpenSpace space;
  space.carve({0, 0, 0}, {39, 24, 16});
  EXPECT_TRUE(findOpenings(space.freeze(), kBox).empty());
}

}  // namespace
}  // namespace spelunk::map
