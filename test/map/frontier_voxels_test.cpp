#include "spelunk/map/frontier_voxels.h"

#include <gtest/gtest.h>

#include <vector>

#include "map/block_map.h"
#include "map/frozen_blocks.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::map {
namespace {

constexpr double kResolution = 0.2;
const VoxelIndex kCorner(-37, -9, -11);  // chunks begin at multiples of 32
const VoxelIndex kSize(70, 40, 26);      // more than two chunks along x

/// A map whose voxels change at random; known ones stay known.
class GrowingMap {
 public:
  std::shared_ptr<const FrozenMap> set(const VoxelIndex& voxel, Occupancy status) {
    enter(voxel, status);
    return freeze();
  }
  void enter(const VoxelIndex& voxel, Occupancy status) {
    blocks_.setValue(packIndex(voxel), status == Occupancy::kOccupied ? 1.0F : -1.0F);
  }
  /// A box of free space with some occupied voxels in it.
  void enterBox(Rng& rng) {
    VoxelIndex first;
    VoxelIndex last;
    for (int axis = 0; axis < 3; ++axis) {
      first(axis) = kCorner(axis) + rng.below(kSize(axis));
      last(axis) = std::min(first(axis) + rng.below(14), kCorner(axis) + kSize(axis) - 1);
    }
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x)
          enter({x, y, z}, rng.below(6) == 0 ? Occupancy::kOccupied : Occupancy::kFree);
  }
  std::shared_ptr<const FrozenMap> freeze() {
    const FrozenMap::Blocks nothing;
    const FrozenMap::Blocks& last = frozen_ ? frozen_->blocks() : nothing;
    frozen_ = std::make_shared<const FrozenMap>(
        freezeBlocks(blocks_, SilentVoxels{}, {blocks_.takeStatusChanges(), {}}, last),
        kResolution);
    return frozen_;
  }

 private:
  BlockMap blocks_{LogOdds(MapParams{})};
  std::shared_ptr<const FrozenMap> frozen_;
};

bool isFrontier(const FrozenMap& map, const VoxelIndex& voxel) {
  if (map.at(voxel) != Occupancy::kFree) return false;
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      VoxelIndex beside = voxel;
      beside(axis) += step;
      if (map.at(beside) == Occupancy::kUnknown) return true;
    }
  return false;
}

/// Every voxel of the map's extent is looked at.
std::size_t expectEqualsBruteForce(const FrontierVoxels& frontier, const FrozenMap& map) {
  std::size_t count = 0;
  for (int z = -1; z <= kSize.z(); ++z)
    for (int y = -1; y <= kSize.y(); ++y)
      for (int x = -1; x <= kSize.x(); ++x) {
        const VoxelIndex voxel = kCorner + VoxelIndex(x, y, z);
        const bool wanted = isFrontier(map, voxel);
        EXPECT_EQ(frontier.contains(voxel), wanted) << voxel.transpose();
        count += wanted ? 1 : 0;
      }
  EXPECT_EQ(frontier.count(), count);
  EXPECT_EQ(frontier.all().size(), count);
  return count;
}

TEST(FrontierVoxels, EqualBruteForceWhileTheMapGrowsAndChanges) {
  Rng rng(5);
  GrowingMap map;
  FrontierVoxels frontier;
  std::size_t most = 0;
  for (int round = 0; round < 25; ++round) {
    for (int k = 0; k < 3; ++k) map.enterBox(rng);
    const auto frozen = map.freeze();
    frontier.update(frozen);
    most = std::max(most, expectEqualsBruteForce(frontier, *frozen));
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  EXPECT_GT(most, 1000U);
}

TEST(FrontierVoxels, TakeUpAMapThatDidNotComeFromTheLast) {
  Rng rng(6);
  GrowingMap one;
  GrowingMap other;
  for (int k = 0; k < 5; ++k) one.enterBox(rng);
  for (int k = 0; k < 5; ++k) other.enterBox(rng);
  FrontierVoxels frontier;
  frontier.update(one.freeze());
  const auto frozen = other.freeze();
  frontier.update(frozen);
  EXPECT_GT(expectEqualsBruteForce(frontier, *frozen), 0U);
}

TEST(FrontierVoxels, LeaveAFreeVoxelWhenItsLastNeighbourIsSeen) {
  GrowingMap map;
  FrontierVoxels frontier;
  const VoxelIndex middle(31, 0, 0);  // its neighbours lie in four chunks
  frontier.update(map.set(middle, Occupancy::kFree));
  const VoxelIndex beside[] = {{30, 0, 0}, {32, 0, 0}, {31, -1, 0}, {31, 1, 0}, {31, 0, -1}};
  for (const VoxelIndex& voxel : beside) frontier.update(map.set(voxel, Occupancy::kOccupied));
  EXPECT_TRUE(frontier.contains(middle));
  frontier.update(map.set({31, 0, 1}, Occupancy::kOccupied));
  EXPECT_FALSE(frontier.contains(middle));
  EXPECT_EQ(frontier.count(), 0U);
}

TEST(FrontierVoxels, WithinABoxAreThoseWhoseCentresLieInIt) {
  Rng rng(7);
  GrowingMap map;
  for (int k = 0; k < 12; ++k) map.enterBox(rng);
  const auto frozen = map.freeze();
  FrontierVoxels frontier;
  frontier.update(frozen);
  std::size_t found = 0;
  for (int k = 0; k < 40; ++k) {
    const Eigen::Vector3d centre = frozen->centreOf(
        kCorner + VoxelIndex(rng.below(kSize.x()), rng.below(kSize.y()), rng.below(kSize.z())));
    const AxisAlignedBox box = boxAround(centre, {rng.uniform(0.1, 8.0), 3.0, 2.5});
    std::size_t wanted = 0;
    for (const VoxelIndex& voxel : frontier.all())
      wanted += box.contains(frozen->centreOf(voxel)) ? 1 : 0;
    const std::vector<VoxelIndex> got = frontier.within(box);
    EXPECT_EQ(got.size(), wanted);
    EXPECT_EQ(frontier.countWithin(box), wanted);
    for (const VoxelIndex& voxel : got) EXPECT_TRUE(box.contains(frozen->centreOf(voxel)));
    found += wanted;
  }
  EXPECT_GT(found, 100U);
}

TEST(FrontierVoxels, TellWhereTheyChangedLast) {
  GrowingMap map;
  FrontierVoxels frontier;
  frontier.update(map.set({0, 0, 0}, Occupancy::kFree));
  const AxisAlignedBox here = boxAround({0.1, 0.1, 0.1}, Eigen::Vector3d::Constant(1.0));
  const AxisAlignedBox far = boxAround({40.0, 0.1, 0.1}, Eigen::Vector3d::Constant(1.0));
  const std::uint64_t first = frontier.lastChangeNear(here);
  EXPECT_GT(first, 0U);
  EXPECT_EQ(frontier.lastChangeNear(far), 0U);
  frontier.update(map.set({200, 0, 0}, Occupancy::kFree));
  EXPECT_EQ(frontier.lastChangeNear(here), first);
  EXPECT_GT(frontier.lastChangeNear(far), first);
}

TEST(FrontierVoxels, AreNoneWithoutAMap) {
  const FrontierVoxels frontier;
  EXPECT_EQ(frontier.count(), 0U);
  EXPECT_TRUE(frontier.all().empty());
  EXPECT_FALSE(frontier.contains({0, 0, 0}));
  FrontierVoxels asked;
  EXPECT_THROW(asked.update(nullptr), Precondition);
}

}  // namespace
}  // namespace spelunk::map
