#include "spelunk/evaluation/reachable_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/world_generator.h"
#include "support/mesh_checks.h"
#include "support/meshes.h"

namespace spelunk::evaluation {
namespace {

/// A room of 4.2 x 3.4 x 3.0 m whose walls lie in the middle of voxels of 0.2 m.
sim::WorldMesh offsetRoom() {
  sim::WorldMesh mesh;
  mesh.name = "offset_room";
  test::addBox(mesh, {0.1F, 0.1F, 0.1F}, {4.3F, 3.5F, 3.1F});
  return mesh;
}

TEST(ReachableVolume, OfABoxIsItsInsideAndItsShell) {
  const ReachableVolume volume = reachableVolume(offsetRoom(), {2.0, 2.0, 1.0});
  const double voxel = std::pow(0.2, 3);
  const double inside = 20 * 16 * 14;
  const double with_shell = 22 * 18 * 16;
  EXPECT_NEAR(volume.free_m3, inside * voxel, 1e-6);
  EXPECT_NEAR(volume.total_m3, with_shell * voxel, 1e-6);
  EXPECT_NEAR(volume.surface_m3, (with_shell - inside) * voxel, 1e-6);
  EXPECT_FALSE(volume.leak);
}

TEST(ReachableVolume, LeavesOutARoomWithoutADoor) {
  sim::WorldMesh mesh = offsetRoom();
  const double alone = reachableVolume(mesh, {2.0, 2.0, 1.0}).total_m3;
  test::addBox(mesh, {10.1F, 0.1F, 0.1F}, {30.3F, 20.5F, 3.1F});
  EXPECT_DOUBLE_EQ(reachableVolume(mesh, {2.0, 2.0, 1.0}).total_m3, alone);
}

TEST(ReachableVolume, TakesOutWhatStandsInTheRoom) {
  sim::WorldMesh mesh = offsetRoom();
  const ReachableVolume empty = reachableVolume(mesh, {1.0, 1.0, 1.0});
  test::addBox(mesh, {2.1F, 1.1F, 1.1F}, {3.1F, 2.1F, 2.1F});
  const ReachableVolume with_box = reachableVolume(mesh, {1.0, 1.0, 1.0});
  EXPECT_NEAR(empty.free_m3 - with_box.free_m3, 6 * 6 * 6 * std::pow(0.2, 3), 1e-6);
}

TEST(ReachableVolume, SaysThatAnOpenMeshLeaks) {
  sim::WorldMesh mesh = offsetRoom();
  mesh.triangles.pop_back();
  const ReachableVolume volume = reachableVolume(mesh, {2.0, 2.0, 1.0});
  EXPECT_TRUE(volume.leak);
  const Eigen::Vector3d widened = mesh.bounds().size() + Eigen::Vector3d::Constant(0.8);
  EXPECT_LE(volume.total_m3, widened.prod());
}

TEST(ReachableVolume, RefusesAStartInTheWallOrOutside) {
  EXPECT_THROW(static_cast<void>(reachableVolume(offsetRoom(), {0.1, 2.0, 1.0})), OutsideError);
  EXPECT_THROW(static_cast<void>(reachableVolume(offsetRoom(), {90.0, 2.0, 1.0})), OutsideError);
}

TEST(ReachableVolume, SurfaceVoxelsAreThoseTheMeshMeets) {
  const sim::WorldMesh mesh =
      sim::generateWorld(std::string(SPELUNK_SOURCE_DIR) + "/worlds/room.yaml");
  const ReachableVolume volume = reachableVolume(mesh, mesh.start->position);
  const sim::MeshScene scene(mesh);
  const AxisAlignedBox bounds = mesh.bounds();
  const auto first = [&](int axis) { return static_cast<int>(std::floor(bounds.min[axis] / 0.2)); };
  const auto last = [&](int axis) { return static_cast<int>(std::floor(bounds.max[axis] / 0.2)); };
  int met = 0;
  for (int z = first(2); z <= last(2); ++z)
    for (int y = first(1); y <= last(1); ++y)
      for (int x = first(0); x <= last(0); ++x) {
        const Eigen::Vector3d centre = 0.2 * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
        met += scene.boxDistance(centre, Eigen::Vector3d::Constant(0.2), 0.01) <= 0.0 ? 1 : 0;
      }
  EXPECT_NEAR(volume.surface_m3 / std::pow(0.2, 3), met, 0.005 * met);
}

TEST(ReachableVolume, OfAGeneratedWorldFitsItsEnclosedVolume) {
  const sim::WorldMesh mesh =
      sim::generateWorld(std::string(SPELUNK_SOURCE_DIR) + "/worlds/tiny_maze.yaml");
  const ReachableVolume volume = reachableVolume(mesh, mesh.start->position);
  const double enclosed = test::enclosedVolume(mesh);
  EXPECT_LT(volume.free_m3, enclosed);
  EXPECT_GT(volume.total_m3, enclosed);
  EXPECT_NEAR(volume.free_m3 + 0.5 * volume.surface_m3, enclosed, 0.05 * enclosed);
  EXPECT_FALSE(volume.leak);
}

}  // namespace
}  // namespace spelunk::evaluation
