#include "map/ray_walks.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "map/scan_tracer.h"
#include "spelunk/common/rng.h"

namespace spelunk::map {
namespace {

/// What is marked, by block; blocks without marks left out.
std::map<PackedKey, Mask> freeOf(const ScanMarks& marks) {
  std::map<PackedKey, Mask> free;
  for (const ScanMarks::Block& block : marks.blocks())
    if (block.free != Mask{}) free[block.key] = block.free;
  return free;
}

RayWalks walksFrom(const Eigen::Vector3f& origin, int rays, float reach, Rng& rng) {
  MapParams params;
  params.resolution_m = 0.15;
  ScanEnds ends;
  ends.makeRoomFor(static_cast<std::size_t>(rays));
  const auto draw = [&] { return reach * static_cast<float>(2.0 * rng.uniform() - 1.0); };
  for (int i = 0; i < rays; ++i) {
    Eigen::Vector3f end = origin + Eigen::Vector3f(draw(), draw(), 0.2F * draw());
    if (i % 7 == 0) end.y() = origin.y();  // along an axis plane
    const VoxelIndex voxel = voxelOf(end.cast<double>(), 1.0 / params.resolution_m);
    if (i % 11 == 0)
      end = ((voxel.cast<double>().array() + 0.5) * params.resolution_m).cast<float>();
    ends.set(ends.count++, end, voxel);
  }
  RayWalks walks;
  ScanMarks hits;
  ScanTracer(params).layOut(origin, ends, hits, walks);
  return walks;
}

RayWalks reversed(const RayWalks& walks) {
  RayWalks reversed = walks;
  for (std::size_t i = 0; i < walks.count; ++i) reversed.set(i, walks.at(walks.count - 1 - i));
  return reversed;
}

TEST(RayMarker, MarksWhatWalkingOneByOneMarks) {
  Rng rng(4);
  RayMarker marker;
  RayMarker scalar(WalkLanes::kOne);
  for (int round = 0; round < 20; ++round) {
    const auto shift = static_cast<float>(round);
    const Eigen::Vector3f origin(shift * 3.7F - 30.0F, 1.3F * shift, -0.4F * shift);
    const auto walks = walksFrom(origin, 300, round % 2 == 0 ? 40.0F : 2.0F, rng);
    ScanMarks fast;
    ScanMarks plain;
    marker.markFree(walks, fast);
    RayMarker::markFreeOneByOne(walks, plain);
    ScanMarks by_scalars;
    scalar.markFree(walks, by_scalars);
    ASSERT_EQ(freeOf(fast), freeOf(plain)) << "round " << round;
    ASSERT_EQ(freeOf(by_scalars), freeOf(plain)) << "round " << round;
    ASSERT_GT(freeOf(plain).size(), 5U);
  }
}

TEST(RayMarker, DoesNotDependOnTheOrderOfTheRays) {
  Rng rng(6);
  RayMarker marker;
  const RayWalks walks = walksFrom({0.1F, 0.2F, 0.3F}, 200, 20.0F, rng);
  ScanMarks forwards;
  marker.markFree(walks, forwards);
  ScanMarks backwards;
  marker.markFree(reversed(walks), backwards);
  ASSERT_EQ(forwards.blocks().size(), backwards.blocks().size());
  for (std::size_t i = 0; i < forwards.blocks().size(); ++i) {
    ASSERT_EQ(forwards.blocks()[i].key, backwards.blocks()[i].key);
    ASSERT_EQ(forwards.blocks()[i].free, backwards.blocks()[i].free);
  }
}

TEST(RayMarker, WalksRaysTooFarForAGridOneByOne) {
  const double never = std::numeric_limits<double>::max();
  RayWalks walks;
  walks.start = VoxelIndex::Zero();
  walks.resize(2);
  for (int axis = 0; axis < 2; ++axis) {  // a grid around both would be huge
    RayWalk walk{{never, never, never}, {never, never, never}, {0, 0, 0}, VoxelIndex::Zero(), 1e6};
    walk.next[axis] = walk.spacing[axis] = 1.0;
    walk.step[axis] = 1;
    walk.end(axis) = 30000;
    walks.set(static_cast<std::size_t>(axis), walk);
  }
  ScanMarks marks;
  RayMarker{}.markFree(walks, marks);
  int voxels = 0;
  for (const auto& [key, mask] : freeOf(marks))
    for (const std::uint64_t word : mask) voxels += __builtin_popcountll(word);
  EXPECT_EQ(voxels, 30000 + 30000 - 1) << "both start in one voxel";
}

TEST(RayMarker, OfNoRaysMarksNothing) {
  ScanMarks marks;
  RayMarker{}.markFree(RayWalks{}, marks);
  EXPECT_TRUE(marks.blocks().empty());
}

}  // namespace
}  // namespace spelunk::map
