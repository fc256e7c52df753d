#include "map/ray_walks.h"

#include <gtest/gtest.h>

#include <algorithm>
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

std::vector<RayWalk> walksFrom(const Eigen::Vector3f& origin, int rays, float reach, Rng& rng) {
  std::vector<RayWalk> walks;
  ScanTracer tracer(origin, 0.15, 50.0, walks);
  ScanMarks hits;
  const auto draw = [&] { return reach * static_cast<float>(2.0 * rng.uniform() - 1.0); };
  for (int i = 0; i < rays; ++i) {
    Eigen::Vector3f end = origin + Eigen::Vector3f(draw(), draw(), 0.2F * draw());
    if (i % 7 == 0) end.y() = origin.y();  // along an axis plane
    if (i % 11 == 0) end = tracer.centreAround(end);
    tracer.add(end, hits);
  }
  return walks;
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
  auto walks = walksFrom({0.1F, 0.2F, 0.3F}, 200, 20.0F, rng);
  ScanMarks forwards;
  marker.markFree(walks, forwards);
  std::reverse(walks.begin(), walks.end());
  ScanMarks backwards;
  marker.markFree(walks, backwards);
  ASSERT_EQ(forwards.blocks().size(), backwards.blocks().size());
  for (std::size_t i = 0; i < forwards.blocks().size(); ++i) {
    ASSERT_EQ(forwards.blocks()[i].key, backwards.blocks()[i].key);
    ASSERT_EQ(forwards.blocks()[i].free, backwards.blocks()[i].free);
  }
}

TEST(RayMarker, WalksRaysTooFarForAGridOneByOne) {
  RayWalk walk{};
  const double never = std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis) {
    walk.next[axis] = walk.spacing[axis] = axis == 0 ? 1.0 : never;
    walk.step[axis] = axis == 0 ? 1 : 0;
  }
  walk.start = VoxelIndex::Zero();
  walk.end = VoxelIndex(40, 0, 0);
  walk.length = 1e3;
  RayWalk other = walk;
  std::swap(other.next[0], other.next[1]);
  std::swap(other.spacing[0], other.spacing[1]);
  std::swap(other.step[0], other.step[1]);
  other.start = VoxelIndex(20000, 20000, 500);  // a grid around both would be huge
  other.end = VoxelIndex(20000, 20009, 500);
  ScanMarks marks;
  RayMarker{}.markFree({walk, other}, marks);
  int voxels = 0;
  for (const auto& [key, mask] : freeOf(marks))
    for (const std::uint64_t word : mask) voxels += __builtin_popcountll(word);
  EXPECT_EQ(voxels, 40 + 9);
}

TEST(RayMarker, OfNoRaysMarksNothing) {
  ScanMarks marks;
  RayMarker{}.markFree({}, marks);
  EXPECT_TRUE(marks.blocks().empty());
}

}  // namespace
}  // namespace spelunk::map
