#include "spelunk/evaluation/explored_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "spelunk/sim/world_generator.h"
#include "support/meshes.h"
#include "support/scans.h"

namespace spelunk::evaluation {
namespace {

constexpr double kEdge_m = 0.2;
constexpr double kVoxel_m3 = kEdge_m * kEdge_m * kEdge_m;

SensorModel lidar(int rows, int columns, double range_max_m) {
  SensorModel sensor;
  sensor.rows = rows;
  sensor.columns = columns;
  sensor.range_max_m = range_max_m;
  return sensor;
}

using Voxels = std::set<std::array<int, 3>>;

/// All voxels a segment passes, from the sorted lengths at which it crosses the planes of the grid.
void addVoxelsOf(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length,
                 Voxels& voxels) {
  std::vector<double> cuts{0.0, length};
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-12) continue;
    const double to = from[axis] + length * direction[axis];
    const auto first = static_cast<int>(std::floor(std::min(from[axis], to) / kEdge_m));
    const auto last = static_cast<int>(std::ceil(std::max(from[axis], to) / kEdge_m));
    for (int plane = first; plane <= last; ++plane) {
      const double cut = (plane * kEdge_m - from[axis]) / direction[axis];
      if (cut > 0.0 && cut < length) cuts.push_back(cut);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (cuts[i] - cuts[i - 1] < 1e-9) continue;
    const Eigen::Vector3d middle = from + 0.5 * (cuts[i] + cuts[i - 1]) * direction;
    voxels.insert({static_cast<int>(std::floor(middle.x() / kEdge_m)),
                   static_cast<int>(std::floor(middle.y() / kEdge_m)),
                   static_cast<int>(std::floor(middle.z() / kEdge_m))});
  }
}

void addVoxelsOf(const sim::SimulatedScan& scan, Voxels& voxels) {
  const Eigen::Matrix3d rotation = scan.T_world_sensor_true.linear();
  for (std::size_t i = 0; i < scan.true_ranges.size(); ++i)
    addVoxelsOf(scan.T_world_sensor_true.translation(),
                rotation * (*scan.directions)[i].cast<double>(), scan.true_ranges[i], voxels);
}

TEST(ExploredVolume, IsNothingBeforeTheFirstScan) {
  EXPECT_EQ(ExploredVolume(test::boxRoom({8, 6, 3}).bounds()).volume_m3(), 0.0);
}

TEST(ExploredVolume, CountsTheVoxelsAPlainWalkCounts) {
  const sim::WorldMesh mesh = test::corridorWithPillar(20.1F, 3.1F);
  const sim::MeshScene scene(mesh);
  ExploredVolume explored(mesh.bounds(), kEdge_m, RayChoice::kAll);
  Voxels plain;
  for (const double x : {2.137, 5.291, 8.873}) {
    const auto scan = test::scanFrom(scene, lidar(16, 180, 50.0), {x, 0.713, 1.157}, 0.3137 * x);
    explored.add(scan);
    addVoxelsOf(scan, plain);
    // Rounding decides a handful of voxels that rays only graze or end at.
    EXPECT_NEAR(explored.volume_m3() / kVoxel_m3, static_cast<double>(plain.size()),
                0.001 * static_cast<double>(plain.size()));
  }
}

TEST(ExploredVolume, CountsARayWithoutReturnAsFreeUpToItsRange) {
  sim::SimulatedScan scan;
  scan.directions = std::make_shared<const std::vector<Eigen::Vector3f>>(
      std::vector<Eigen::Vector3f>{{1.0F, 0.0F, 0.0F}});
  scan.T_world_sensor_true.translation() = Eigen::Vector3d(0.1, 0.1, 0.1);
  scan.true_ranges = {10.0F};
  scan.range_max_m = 10.0F;
  ExploredVolume explored({{0.0, 0.0, 0.0}, {30.0, 1.0, 1.0}});
  explored.add(scan);
  EXPECT_NEAR(explored.volume_m3() / kVoxel_m3, 51.0, 1e-6);
}

TEST(ExploredVolume, CountsNothingOutsideItsBounds) {
  const sim::WorldMesh mesh = test::boxRoom({20, 20, 4});
  const sim::MeshScene scene(mesh);
  const AxisAlignedBox part{{-2.0, -2.0, 0.0}, {2.0, 2.0, 4.0}};
  ExploredVolume explored(part);
  explored.add(test::scanFrom(scene, lidar(16, 360, 50.0), {0.0, 0.0, 1.5}));
  const Eigen::Vector3d widened = part.size() + Eigen::Vector3d::Constant(4.0 * kEdge_m);
  EXPECT_GT(explored.volume_m3(), 1.0);
  EXPECT_LE(explored.volume_m3(), widened.prod());
}

TEST(ExploredVolume, ASecondScanFromTheSamePlaceAddsNothing) {
  const sim::WorldMesh mesh = test::boxRoom({9, 7, 3});
  const sim::MeshScene scene(mesh);
  const auto scan = test::scanFrom(scene, lidar(16, 360, 50.0), {0.3, 0.2, 1.3});
  ExploredVolume explored(mesh.bounds(), kEdge_m, RayChoice::kAll);
  explored.add(scan);
  const double once = explored.volume_m3();
  explored.add(scan);
  EXPECT_EQ(explored.volume_m3(), once);
}

TEST(ExploredVolume, SkippingRaysCountsNeverMoreAndLessByTwoPerCentAtMost) {
  const sim::WorldMesh mesh =
      sim::generateWorld(std::string(SPELUNK_SOURCE_DIR) + "/worlds/tiny_maze.yaml");
  const sim::MeshScene scene(mesh);
  ExploredVolume all(mesh.bounds(), kEdge_m, RayChoice::kAll);
  ExploredVolume skipping(mesh.bounds(), kEdge_m, RayChoice::kOneAnEnding);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d at(0.01 * i, 0.013 * i, 1.0 + 0.002 * i);
    auto scan = test::scanFrom(scene, lidar(16, 1800, 50.0), at, 0.01 * i);
    scan.scan.stamp_s = 0.1 * i;
    all.add(scan);
    skipping.add(scan);
  }
  EXPECT_GT(all.volume_m3(), 20.0);
  EXPECT_LE(skipping.volume_m3(), all.volume_m3());
  EXPECT_GT(skipping.volume_m3(), 0.98 * all.volume_m3());
}

TEST(ExploredVolume, ScansThatFollowLateAreAllCounted) {
  const sim::WorldMesh mesh = test::boxRoom({9, 7, 3});
  const sim::MeshScene scene(mesh);
  const Eigen::Vector3d places[] = {{-3.0, -2.0, 1.0}, {3.0, 2.0, 1.0}, {0.0, 1.0, 2.0}};
  ExploredVolume all(mesh.bounds(), kEdge_m, RayChoice::kAll);
  ExploredVolume late(mesh.bounds(), kEdge_m, RayChoice::kOneAnEnding);
  ExploredVolume early(mesh.bounds(), kEdge_m, RayChoice::kOneAnEnding);
  double stamp_s = 0.0;
  for (const Eigen::Vector3d& place : places) {
    auto scan = test::scanFrom(scene, lidar(16, 90, 50.0), place);
    all.add(scan);
    scan.scan.stamp_s = stamp_s += 0.4;
    late.add(scan);
    scan.scan.stamp_s = 0.1 * stamp_s;
    early.add(scan);
  }
  EXPECT_GT(late.volume_m3(), 0.99 * all.volume_m3());
  EXPECT_LT(early.volume_m3(), 0.9 * all.volume_m3());
}

/// A wall of panels of 1 x 1 m that leave cracks of `crack_m` between each other; `u` and `v` span
/// it in whole metres.
void addPanels(sim::WorldMesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
               const Eigen::Vector3f& v, float crack_m) {
  const Eigen::Vector3f along = u.normalized(), across = v.normalized();
  for (int i = 0; static_cast<float>(i) < u.norm(); ++i)
    for (int j = 0; static_cast<float>(j) < v.norm(); ++j) {
      const Eigen::Vector3f low = corner + along * (static_cast<float>(i) + 0.5F * crack_m) +
                                  across * (static_cast<float>(j) + 0.5F * crack_m);
      const int base = static_cast<int>(mesh.vertices.size());
      const float edge = 1.0F - crack_m;
      for (const Eigen::Vector3f& place : {low, Eigen::Vector3f(low + edge * along),
                                           Eigen::Vector3f(low + edge * along + edge * across),
                                           Eigen::Vector3f(low + edge * across)})
        mesh.vertices.push_back(place);
      mesh.triangles.emplace_back(base, base + 1, base + 2);
      mesh.triangles.emplace_back(base, base + 2, base + 3);
    }
}

/// 10 x 8 x 4 m from (0.1, 0.1, 0.1) on, in the middle of bounds of 30 x 28 x 24 m.
sim::WorldMesh crackedRoom(float crack_m) {
  sim::WorldMesh mesh;
  mesh.name = "cracked_room";
  const Eigen::Vector3f low(0.1F, 0.1F, 0.1F), x(10.0F, 0.0F, 0.0F), y(0.0F, 8.0F, 0.0F),
      z(0.0F, 0.0F, 4.0F);
  addPanels(mesh, low, x, y, crack_m);
  addPanels(mesh, low + z, x, y, crack_m);
  addPanels(mesh, low, x, z, crack_m);
  addPanels(mesh, low + y, x, z, crack_m);
  addPanels(mesh, low, y, z, crack_m);
  addPanels(mesh, low + x, y, z, crack_m);
  test::addBox(mesh, {-10.0F, -10.0F, -10.0F}, {-9.0F, -9.0F, -9.0F});
  test::addBox(mesh, {19.0F, 17.0F, 13.0F}, {20.0F, 18.0F, 14.0F});
  return mesh;
}

TEST(ExploredVolume, WhatIsSeenThroughCracksIsCountedApart) {
  const sim::WorldMesh mesh = crackedRoom(0.04F);
  const sim::MeshScene scene(mesh);
  const ReachableSpace space = reachableSpace(mesh, {5.0, 4.0, 2.0});
  EXPECT_FALSE(space.leak);
  ExploredVolume explored(mesh.bounds());
  SeenVolume before;
  for (int k = 0; k < 20; ++k) {
    auto scan = test::scanFrom(scene, lidar(64, 900, 50.0), {1.3 + 0.4 * k, 4.0, 2.0}, 0.1 * k);
    scan.scan.stamp_s = k;
    explored.add(scan);
    const SeenVolume seen = explored.partedBy(space);
    EXPECT_GE(seen.inside_m3, before.inside_m3);
    EXPECT_GE(seen.outside_m3, before.outside_m3);
    before = seen;
  }
  EXPECT_NEAR(before.inside_m3 + before.outside_m3, explored.volume_m3(), 1e-6);
  EXPECT_GT(before.outside_m3, 100.0);
  EXPECT_GT(before.inside_m3, 0.7 * 10.0 * 8.0 * 4.0);
  EXPECT_LE(before.inside_m3, volumeOf(space).total_m3);
}

TEST(ExploredVolume, OfAClosedMeshNothingLiesOutside) {
  const sim::WorldMesh mesh =
      sim::generateWorld(std::string(SPELUNK_SOURCE_DIR) + "/worlds/tiny_maze.yaml");
  const sim::MeshScene scene(mesh);
  const ReachableSpace space = reachableSpace(mesh, mesh.start->position);
  EXPECT_TRUE(space.is_enclosed);
  ExploredVolume explored(mesh.bounds());
  explored.add(test::scanFrom(scene, lidar(64, 900, 50.0), mesh.start->position));
  const SeenVolume seen = explored.partedBy(space);
  EXPECT_EQ(seen.inside_m3, explored.volume_m3());
  EXPECT_EQ(seen.outside_m3, 0.0);
}

}  // namespace
}  // namespace spelunk::evaluation
