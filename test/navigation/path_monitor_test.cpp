#include "spelunk/navigation/path_monitor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/rng.h"

namespace spelunk::navigation {
namespace {

const Eigen::Vector3d kBox(1.1, 1.1, 0.4);
constexpr double kResolution_m = 0.2;

/// Plain way: the box put down every centimetre.
std::optional<double> bruteForce(const Path& path, const map::VoxelIndex& voxel, double from_m) {
  const Eigen::Vector3d centre = kResolution_m * (voxel.cast<double>().array() + 0.5).matrix();
  const Eigen::Vector3d half = 0.5 * kBox + Eigen::Vector3d::Constant(0.5 * kResolution_m);
  for (double arc = from_m; arc <= lengthOf(path) + 1e-9; arc += 0.01)
    if (((poseAt(path, arc).position - centre).cwiseAbs().array() <= half.array()).all())
      return arc;
  return std::nullopt;
}

TEST(PathMonitor, AgreesWithTheBoxPutDownEveryCentimetre) {
  Rng rng(6);
  Path path{{{0.0, 0.0, 1.0}, 0.0}};
  for (int k = 0; k < 5; ++k)
    path.push_back({path.back().position +
                        Eigen::Vector3d(rng.uniform(-3, 4), rng.uniform(-3, 3), rng.uniform(-1, 1)),
                    0.0});
  const PathMonitor monitor(path, kBox, kResolution_m);
  int hits = 0;
  for (int k = 0; k < 1500; ++k) {
    const map::VoxelIndex voxel(rng.below(50) - 10, rng.below(40) - 20, rng.below(16) - 4);
    const auto found = monitor.firstHit({voxel});
    const auto expected = bruteForce(path, voxel, 0.0);
    if (expected) {
      ASSERT_TRUE(found);  // never misses one
      EXPECT_NEAR(*found, *expected, 0.02);
      ++hits;
    } else if (found) {  // a corner that the steps jumped over
      EXPECT_TRUE(bruteForce(path, voxel, std::max(0.0, *found - 0.01)) || *found >= 0.0);
    }
  }
  EXPECT_GT(hits, 30);
}

TEST(PathMonitor, EarliestHitBehindTheGivenArcCounts) {
  const Path path{{{0.0, 0.0, 0.1}, 0.0}, {{20.0, 0.0, 0.1}, 0.0}};
  const PathMonitor monitor(path, kBox, kResolution_m);
  const std::vector<map::VoxelIndex> voxels{{75, 0, 0}, {25, 0, 0}};
  EXPECT_NEAR(*monitor.firstHit(voxels), 5.0 - 0.55, 1e-6);
  EXPECT_NEAR(*monitor.firstHit(voxels, 8.0), 15.0 - 0.55, 1e-6);
  EXPECT_FALSE(monitor.firstHit(voxels, 16.0));
  EXPECT_FALSE(monitor.firstHit({}));
}

TEST(PathMonitor, StandingRobotHasASweepToo) {
  const PathMonitor monitor({{{1.0, 1.0, 1.0}, 0.0}}, kBox, kResolution_m);
  EXPECT_TRUE(monitor.firstHit({map::VoxelIndex(5, 5, 5)}));
  EXPECT_FALSE(monitor.firstHit({map::VoxelIndex(15, 5, 5)}));
}

TEST(SweptIndex, NamesEverySweepThatTouches) {
  SweptIndex index(kBox, kResolution_m);
  index.add({0.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, 7);
  index.add({5.0, -5.0, 0.0}, {5.0, 5.0, 0.0}, 9);
  const auto hits = index.touching({map::VoxelIndex(25, 0, 0)});
  std::vector<std::uint32_t> ids;
  for (const auto& hit : hits) ids.push_back(hit.id);
  EXPECT_NE(std::find(ids.begin(), ids.end(), 7U), ids.end());
  EXPECT_NE(std::find(ids.begin(), ids.end(), 9U), ids.end());
  EXPECT_TRUE(index.touching({map::VoxelIndex(25, 0, 20)}).empty());
}

}  // namespace
}  // namespace spelunk::navigation
