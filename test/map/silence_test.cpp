#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "map/silence_watch.h"
#include "map/silent_voxels.h"
#include "map_worlds.h"
#include "spelunk/common/rng.h"
#include "spelunk/map/occupancy_map.h"
#include "support/temporary_folder.h"

namespace spelunk::map {
namespace {

constexpr double kResolution = 0.2;
constexpr double kHeight_m = 0.4;  // of the robot

/// So few rays that each has a cell of its own.
SensorModel sparseLidar() {
  SensorModel sensor;
  sensor.rows = 5;
  sensor.columns = 24;
  sensor.range_max_m = 24.0;
  sensor.fov_vertical_deg = 8.0;
  return sensor;
}

/// Voxels free, occupied and unknown at random around the origin.
BlockMap randomBlocks(Rng& rng) {
  BlockMap blocks{LogOdds(MapParams{})};
  for (int z = -20; z < 20; ++z)
    for (int y = -40; y < 40; ++y)
      for (int x = -40; x < 40; ++x) {
        const int draw = rng.below(40);
        if (draw < 26) blocks.setValue(packIndex(x, y, z), draw == 0 ? 1.0F : -1.0F);
      }
  return blocks;
}

/// The lengths at which a ray enters and leaves a voxel; enter > leave if it misses it.
struct Passage {
  double enter = 0.0;
  double leave = 1e9;
};
Passage passageOf(const VoxelIndex& voxel, const Eigen::Vector3d& origin,
                  const Eigen::Vector3d& direction) {
  Passage passage;
  for (int i = 0; i < 3; ++i) {
    double near = (kResolution * voxel(i) - origin(i)) / direction(i);
    double far = (kResolution * (voxel(i) + 1) - origin(i)) / direction(i);
    if (near > far) std::swap(near, far);
    passage.enter = std::max(passage.enter, near);
    passage.leave = std::min(passage.leave, far);
  }
  return passage;
}

/// Looks at every voxel around for each ray.
std::set<PackedKey> byBruteForce(const Scan& scan, const std::vector<Eigen::Vector3d>& rays,
                                 const BlockMap& blocks, double range_m) {
  std::set<PackedKey> looked_into;
  const Eigen::Vector3d origin = scan.T_world_sensor.translation();
  const int reach = static_cast<int>(range_m / kResolution) + 8;
  for (const Eigen::Vector3d& ray : rays) {
    const Eigen::Vector3d direction = scan.T_world_sensor.linear() * ray;
    std::vector<std::pair<double, VoxelIndex>> met;
    for (int z = -12; z < 12; ++z)
      for (int y = -reach; y < reach; ++y)
        for (int x = -reach; x < reach; ++x) {
          const Passage passage = passageOf({x, y, z}, origin, direction);
          if (passage.enter < passage.leave && passage.enter < range_m)
            met.emplace_back(passage.enter, VoxelIndex(x, y, z));
        }
    std::sort(met.begin(), met.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    bool was_free = false;
    int unknown = 0;
    for (const auto& [length, voxel] : met) {
      const Occupancy status = blocks.at(voxel);
      if (status == Occupancy::kOccupied || unknown == SilenceWatch::kDepth) break;
      was_free |= status == Occupancy::kFree;
      unknown = status == Occupancy::kFree ? 0 : unknown + 1;
      if (was_free && status == Occupancy::kUnknown) looked_into.insert(packIndex(voxel));
      if (!was_free) unknown = 0;
    }
  }
  return looked_into;
}

TEST(SilenceWatch, LooksIntoTheVoxelsOnItsSilentRays) {
  Rng rng(3);
  const SensorModel sensor = sparseLidar();
  SilenceWatch watch(sensor, kHeight_m, kResolution);
  EXPECT_DOUBLE_EQ(watch.range(), std::min(kHeight_m / std::tan(2.0 * M_PI / 180.0), 6.0));
  std::size_t count = 0;
  for (int round = 0; round < 3; ++round) {
    const BlockMap blocks = randomBlocks(rng);
    Scan scan;
    scan.T_world_sensor.translate(
        Eigen::Vector3d(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3)));
    scan.T_world_sensor.rotate(Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ()));
    std::vector<Eigen::Vector3d> silent;
    for (const Eigen::Vector3f& ray : rayDirections(sensor))
      if (rng.below(2) == 0)
        scan.points.push_back(7.0F * ray);
      else
        silent.push_back(ray.cast<double>());
    const std::vector<PackedKey> found = watch.voxelsLookedInto(scan, blocks);
    const std::set<PackedKey> got(found.begin(), found.end());
    EXPECT_EQ(got, byBruteForce(scan, silent, blocks, watch.range()));
    count += got.size();
  }
  EXPECT_GT(count, 500U);
}

TEST(SilenceWatch, TakesAScanOnlyFromANewPlace) {
  SilenceWatch watch(sparseLidar(), kHeight_m, kResolution);
  Scan scan;
  EXPECT_TRUE(watch.takes(scan));
  EXPECT_FALSE(watch.takes(scan));
  scan.T_world_sensor.translation().x() = 0.99 * watch.spacing();
  EXPECT_FALSE(watch.takes(scan));
  scan.T_world_sensor.translation().x() = 1.01 * watch.spacing();
  EXPECT_TRUE(watch.takes(scan));
}

TEST(SilenceWatch, FollowsRaysToAQuarterOfTheReachOfADenseSensor) {
  SensorModel camera;
  camera.kind = "depth_camera";
  camera.fov_horizontal_deg = 86.0;
  camera.fov_vertical_deg = 57.0;
  camera.rows = 120;
  camera.columns = 160;
  camera.range_max_m = camera.gain_range_m = 8.0;
  EXPECT_DOUBLE_EQ(SilenceWatch(camera, kHeight_m, kResolution).range(), 2.0);
}

TEST(SilentVoxels, AreThoseLookedIntoThreeTimes) {
  SilentVoxels silence;
  const PackedKey voxel = packIndex(3, -5, 9);
  for (int look = 1; look <= 4; ++look) {
    std::vector<PackedKey> voxels{voxel, packIndex(100 + look, 0, 0), voxel};
    silence.countLook(voxels);
    const bool is_silent =
        ((silence.silentIn(voxel)[static_cast<std::size_t>(wordOf(voxel))] >> bitOf(voxel)) & 1) !=
        0;
    EXPECT_EQ(is_silent, look >= 3) << look;
  }
  EXPECT_EQ(silence.takeChanges(), std::vector<PackedKey>{voxel & ~kInBlockMask});
  EXPECT_TRUE(silence.takeChanges().empty());
  EXPECT_EQ(silence.silentIn(packIndex(101, 0, 0)), Mask{});
}

/// A gallery along x, 4 m wide and high around the origin's height, open at x = 10.
Scan portalScan(const SensorModel& sensor, double x) {
  Scan scan;
  scan.sensor = sensor.name;
  scan.T_world_sensor.translation().x() = x;
  for (const Eigen::Vector3f& ray : rayDirections(sensor)) {
    const double wall = 2.0 / std::max(std::fabs(ray.y()), std::fabs(ray.z()));
    const double back = ray.x() < 0.0F ? (x + 5.0) / -ray.x() : 1e9;
    const double range = std::min(wall, back);
    if (x + range * ray.x() < 10.0) scan.points.push_back(static_cast<float>(range) * ray);
  }
  return scan;
}

class Portal : public ::testing::Test {
 protected:
  void SetUp() override {
    sensor_.rows = 16;
    sensor_.columns = 720;
    sensor_.name = "lidar";
    map_.watchSilence({sensor_}, kHeight_m);
  }
  void lookFrom(double x) { map_.insert(portalScan(sensor_, x), noBody()); }
  /// In the portal and in the bulge before it that no ray comes back from.
  [[nodiscard]] std::size_t silentThere() { return silentBetween(7.0, 11.0); }
  [[nodiscard]] std::size_t silentBetween(double x_min, double x_max) {
    const auto frozen = map_.freeze();
    std::size_t count = 0;
    for (double x = x_min + 0.1; x < x_max; x += 0.2)
      for (double y = -2.1; y < 2.2; y += 0.2)
        for (double z = -2.1; z < 2.2; z += 0.2)
          count += frozen->isSilent(frozen->indexOf({x, y, z})) ? 1 : 0;
    return count;
  }

  SensorModel sensor_;
  OccupancyMap map_{MapParams{}};
};

TEST_F(Portal, IsSilentOnceItWasLookedIntoFromThreePlaces) {
  for (const double x : {3.0, 4.5}) lookFrom(x);
  for (int i = 0; i < 20; ++i) lookFrom(4.5);  // again and again from one place
  EXPECT_EQ(silentThere(), 0U);
  lookFrom(6.0);
  lookFrom(7.5);
  EXPECT_GT(silentThere(), 100U);
  EXPECT_EQ(silentBetween(-6.0, 7.0), 0U);
}

TEST_F(Portal, IsNotSilentWhereSomethingIsSeenLater) {
  for (const double x : {3.0, 4.5, 6.0, 7.5}) lookFrom(x);
  ASSERT_GT(silentThere(), 0U);
  map_.markFree({{6.9, -2.3, -2.3}, {11.1, 2.3, 2.3}});
  EXPECT_EQ(silentThere(), 0U);
}

TEST_F(Portal, IsForgottenWithTheMap) {
  for (const double x : {3.0, 4.5, 6.0, 7.5}) lookFrom(x);
  ASSERT_GT(silentThere(), 0U);
  map_.clear();
  EXPECT_EQ(silentThere(), 0U);
}

TEST_F(Portal, IsLookedIntoAnewFromWhereTheLastLookAtAForgottenMapWas) {
  for (const double x : {3.0, 4.5, 6.0, 7.5}) lookFrom(x);
  map_.clear();
  for (const double x : {7.5, 6.0, 4.5}) lookFrom(x);
  EXPECT_GT(silentThere(), 0U);
}

TEST_F(Portal, IsSilentInAMapThatWasSavedAndLoaded) {
  const test::TemporaryFolder folder;
  for (const double x : {3.0, 4.5, 6.0, 7.5}) lookFrom(x);
  const std::size_t before = silentThere();
  ASSERT_GT(before, 0U);
  map_.save(folder.at("map.ot"));
  map_.saveSilence(folder.at("silence.bt"));
  map_.clear();
  map_.load(folder.at("map.ot"));
  EXPECT_EQ(silentThere(), 0U);
  map_.loadSilence(folder.at("silence.bt"));
  EXPECT_EQ(silentThere(), before);
}

TEST_F(Portal, OfASensorThatReportsMissesIsNotWatched) {
  sensor_.reports_misses = true;
  map_.watchSilence({sensor_}, kHeight_m);
  for (const double x : {3.0, 4.5, 6.0, 7.5}) lookFrom(x);
  EXPECT_EQ(silentThere(), 0U);
}

}  // namespace
}  // namespace spelunk::map
