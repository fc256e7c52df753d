#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"
#include "spelunk/evaluation/reachable_volume.h"
#include "spelunk/sim/mesh_scene.h"
#include "support/meshes.h"

namespace spelunk::evaluation {
namespace {

constexpr double kEdge_m = 0.2;
constexpr double kVoxel_m3 = kEdge_m * kEdge_m * kEdge_m;

/// A far box, so that there is an outside within the bounds.
void addFarBox(sim::WorldMesh& mesh) {
  const AxisAlignedBox bounds = mesh.bounds();
  const Eigen::Vector3f corner = (bounds.max + Eigen::Vector3d(2.0, 1.0, 0.5)).cast<float>();
  test::addBox(mesh, corner, corner + Eigen::Vector3f(1.0F, 1.0F, 1.0F));
  test::addBox(mesh, (bounds.min - Eigen::Vector3d(2.0, 2.0, 2.0)).cast<float>(),
               (bounds.min - Eigen::Vector3d(1.5, 1.5, 1.5)).cast<float>());
}

/// The voxels around a start by the slow and plain way: a voxel is free if a distance query finds
/// no triangle in it, and steps are those between whose ends a ray meets nothing.
std::size_t freeVoxelsByBruteForce(const sim::WorldMesh& mesh, const Eigen::Vector3d& start) {
  const sim::MeshScene scene(mesh);
  VoxelGrid reached(mesh.bounds(), kEdge_m);
  const auto isFree = [&](const Eigen::Vector3i& cell) {
    const Eigen::Vector3d size = Eigen::Vector3d::Constant(kEdge_m - 2e-6);
    return scene.boxDistance(reached.centreOf(cell), size, 0.01) > 0.0;
  };
  std::deque<Eigen::Vector3i> open{reached.cellOf(start)};
  reached.set(reached.offsetOf(open.front()));
  std::size_t count = 1;
  for (; !open.empty(); open.pop_front())
    for (int axis = 0; axis < 3; ++axis)
      for (const int sign : {-1, 1}) {
        const Eigen::Vector3i next = open.front() + sign * Eigen::Vector3i::Unit(axis);
        if (!reached.contains(next) || reached.isSet(reached.offsetOf(next))) continue;
        const Eigen::Vector3d step = sign * Eigen::Vector3d::Unit(axis);
        if (!isFree(next) || scene.castRay(reached.centreOf(open.front()), step, kEdge_m)) continue;
        reached.set(reached.offsetOf(next));
        ++count;
        open.push_back(next);
      }
  return count;
}

/// Where a wall is to lie: on a border of voxels, in the middle of one, or anywhere.
double wallAt(double about_m, Rng& rng) {
  const double on_border = kEdge_m * std::round(about_m / kEdge_m);
  const int kind = static_cast<int>(4.0 * rng.uniform());
  if (kind == 0) return on_border + 0.5 * kEdge_m;
  if (kind == 1) return on_border + 2e-5 * (rng.uniform() - 0.5);
  if (kind == 2) return on_border + kEdge_m * rng.uniform();
  return on_border;
}

/// The sides of a closed prism over an L in the plane, from two heights: a gallery with a bend.
sim::WorldMesh bentGallery(Rng& rng) {
  const double x0 = wallAt(-4.0 * rng.uniform(), rng), y0 = wallAt(3.0 * rng.uniform(), rng);
  const double x1 = wallAt(x0 + 1.4, rng), x2 = wallAt(x0 + 2.2 + 2.0 * rng.uniform(), rng);
  const double y1 = wallAt(y0 + 1.4, rng), y2 = wallAt(y0 + 2.2 + 2.0 * rng.uniform(), rng);
  const double low = wallAt(-1.0 + rng.uniform(), rng), high = wallAt(low + 1.6, rng);
  const std::vector<Eigen::Vector2d> corners{{x0, y0}, {x2, y0}, {x2, y1},
                                             {x1, y1}, {x1, y2}, {x0, y2}};
  sim::WorldMesh mesh;
  mesh.name = "bent_gallery";
  for (const double z : {low, high})
    for (const Eigen::Vector2d& corner : corners)
      mesh.vertices.emplace_back(Eigen::Vector3d(corner.x(), corner.y(), z).cast<float>());
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    mesh.triangles.emplace_back(k, k + 6, next);
    mesh.triangles.emplace_back(next, k + 6, next + 6);
  }
  for (const auto& cap : {Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3),
                          Eigen::Vector3i(0, 3, 4), Eigen::Vector3i(0, 4, 5)}) {
    mesh.triangles.push_back(cap);
    mesh.triangles.push_back((cap.reverse().array() + 6).matrix());
  }
  return mesh;
}

sim::WorldMesh box(Rng& rng) {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (int k = 0; k < 3; ++k) {
    low(k) = wallAt(6.0 * rng.uniform() - 3.0, rng);
    high(k) = wallAt(low(k) + 1.4 + 1.5 * rng.uniform(), rng);
  }
  sim::WorldMesh mesh;
  mesh.name = "box";
  test::addBox(mesh, low.cast<float>(), high.cast<float>());
  return mesh;
}

/// About z, by a quarter, an eighth or anything; in single precision.
void turn(sim::WorldMesh& mesh, Rng& rng) {
  const double angle =
      M_PI_4 * (rng.uniform() < 0.5 ? 1.0 + std::floor(4.0 * rng.uniform()) : rng.uniform());
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = (R * vertex.cast<double>()).cast<float>();
}

/// Half a metre from the first corner of a box or gallery, inside.
Eigen::Vector3d insideOf(const sim::WorldMesh& mesh) {
  const auto at = [&](std::size_t k) -> Eigen::Vector3d { return mesh.vertices[k].cast<double>(); };
  const std::size_t up = mesh.vertices.size() / 2;
  const std::size_t side = mesh.vertices.size() == 8 ? 2 : 5;
  Eigen::Vector3d place = at(0);
  for (const std::size_t k : {std::size_t{1}, side, up})
    place += 0.7 * (at(k) - at(0)).normalized();
  return place;
}

TEST(Watertight, GalleryWithWallsOnWholeMetresHoldsItsVolume) {
  sim::WorldMesh mesh;
  mesh.name = "gallery";
  test::addBox(mesh, {0.0F, 0.0F, 0.0F}, {20.0F, 10.0F, 4.0F});
  const Eigen::Vector3d start(10.0, 5.0, 2.0);
  const ReachableVolume alone = reachableVolume(mesh, start);
  test::addBox(mesh, {30.0F, 0.0F, 0.0F}, {31.0F, 1.0F, 4.0F});
  const ReachableVolume volume = reachableVolume(mesh, start);
  EXPECT_FALSE(volume.leak);
  EXPECT_NEAR(volume.free_m3, 800.0, 1e-6);
  EXPECT_NEAR(volume.total_m3, 102 * 52 * 22 * kVoxel_m3, 1e-6);  // and a shell
  EXPECT_DOUBLE_EQ(volume.total_m3, alone.total_m3);
}

TEST(Watertight, OneFaceOnABorderIsNoLeak) {
  sim::WorldMesh mesh;
  mesh.name = "room";
  test::addBox(mesh, {0.1F, 0.1F, 0.1F}, {14.1F, 8.1F, 5.0F});
  test::addBox(mesh, {300.1F, 0.1F, 0.1F}, {301.1F, 8.1F, 15.0F});
  const ReachableVolume volume = reachableVolume(mesh, {7.0, 4.0, 2.0});
  EXPECT_FALSE(volume.leak);
  EXPECT_NEAR(volume.free_m3, 69 * 39 * 24 * kVoxel_m3, 1e-6);
}

TEST(Watertight, NoFloodLeavesAClosedBoxOrGalleryWhereverItsWallsLie) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Rng rng(seed);
    sim::WorldMesh mesh = rng.uniform() < 0.5 ? box(rng) : bentGallery(rng);
    if (rng.uniform() < 0.5) turn(mesh, rng);
    const Eigen::Vector3d start = insideOf(mesh);
    const std::size_t free_voxels = freeVoxelsByBruteForce(mesh, start);
    addFarBox(mesh);
    const ReachableSpace space = reachableSpace(mesh, start);
    EXPECT_FALSE(space.leak) << mesh.name << " of seed " << seed;
    EXPECT_TRUE(space.is_enclosed) << mesh.name << " of seed " << seed;
    EXPECT_EQ(space.free_voxels, free_voxels) << mesh.name << " of seed " << seed;
  }
}

TEST(Watertight, CoarserVoxelsHoldAsWell) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Rng rng(seed);
    sim::WorldMesh mesh = box(rng);
    const Eigen::Vector3d start = insideOf(mesh);
    addFarBox(mesh);
    for (const double edge_m : {0.05, 0.1, 0.4, 0.5})
      EXPECT_FALSE(reachableSpace(mesh, start, edge_m).leak) << seed << ", " << edge_m;
  }
}

/// A gallery along x with a hole of 1 x 1 m in its roof around (6, 1, 3); (0, 0, 0) to (10, 2, 3).
sim::WorldMesh galleryWithAHole() {
  sim::WorldMesh mesh;
  mesh.name = "holed";
  test::addBox(mesh, {0.0F, 0.0F, 0.0F}, {10.0F, 2.0F, 3.0F});
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the roof
  const int base = static_cast<int>(mesh.vertices.size());
  for (const float x : {0.0F, 5.5F, 6.5F, 10.0F})
    for (const float y : {0.0F, 0.5F, 1.5F, 2.0F}) mesh.vertices.emplace_back(x, y, 3.0F);
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y) {
      if (x == 1 && y == 1) continue;
      const int corner = base + 4 * x + y;
      mesh.triangles.emplace_back(corner, corner + 5, corner + 4);
      mesh.triangles.emplace_back(corner, corner + 1, corner + 5);
    }
  return mesh;
}

TEST(Leak, IsFoundAtTheHoleAndNotWhereTheBoundsEnd) {
  sim::WorldMesh mesh = galleryWithAHole();
  test::addBox(mesh, {0.0F, 20.0F, 0.0F}, {10.0F, 22.0F, 9.0F});
  const ReachableSpace space = reachableSpace(mesh, {1.0, 1.0, 1.0});
  ASSERT_TRUE(space.leak);
  EXPECT_FALSE(space.is_enclosed);
  EXPECT_TRUE(space.leak->is_start_inside);
  EXPECT_LT((space.leak->place - Eigen::Vector3d(6.0, 1.0, 3.0)).cwiseAbs().maxCoeff(), 0.7)
      << space.leak->place.transpose();
}

TEST(Leak, OpenPortalIsClosedByTheBoundsOfTheMesh) {
  sim::WorldMesh mesh;
  mesh.name = "portal";
  test::addBox(mesh, {0.0F, 0.0F, 0.0F}, {20.0F, 4.0F, 4.0F});
  mesh.triangles.resize(10);  // the face at x = 20 is gone
  test::addBox(mesh, {0.0F, 20.0F, 0.0F}, {20.0F, 22.0F, 9.0F});
  const ReachableSpace space = reachableSpace(mesh, {2.0, 2.0, 2.0});
  ASSERT_TRUE(space.leak);
  EXPECT_NEAR(space.leak->place.x(), 20.0, 0.3);
  EXPECT_LT((space.leak->place - Eigen::Vector3d(20.0, 2.0, 2.0)).norm(), 3.0);
  EXPECT_NEAR(volumeOf(space).free_m3, 20.0 * 4.0 * 4.0, 1e-6);
}

TEST(Leak, StartOutsideAClosedMeshSaysSo) {
  sim::WorldMesh mesh;
  mesh.name = "two_boxes";
  test::addBox(mesh, {0.1F, 0.1F, 0.1F}, {4.1F, 4.1F, 4.1F});
  test::addBox(mesh, {10.1F, 0.1F, 0.1F}, {14.1F, 4.1F, 4.1F});
  const ReachableSpace space = reachableSpace(mesh, {7.0, 2.0, 2.0});
  ASSERT_TRUE(space.leak);
  EXPECT_FALSE(space.leak->is_start_inside);
}

TEST(ReachableSpace, BeginsBesideAStartWhoseVoxelHoldsTheFloor) {
  sim::WorldMesh mesh;
  mesh.name = "room";
  test::addBox(mesh, {0.1F, 0.1F, 0.05F}, {4.1F, 4.1F, 3.1F});
  const ReachableSpace space = reachableSpace(mesh, {2.1, 2.1, 0.19});
  EXPECT_FALSE(space.leak);
  EXPECT_EQ(space.free_voxels, reachableSpace(mesh, {2.1, 2.1, 1.0}).free_voxels);
}

TEST(ReachableSpace, RefusesAWorldTooLargeAndGuessesItsUnit) {
  sim::WorldMesh mesh;
  mesh.name = "millimetres";
  test::addBox(mesh, {0.0F, 0.0F, 0.0F}, {40000.0F, 30000.0F, 4000.0F});
  try {
    (void)reachableSpace(mesh, {1000.0, 1000.0, 1000.0});
    FAIL() << "a world of 40 x 30 x 4 km was taken";
  } catch (const OutsideError& error) {
    const std::string text = error.what();
    for (const char* part :
         {"40000 x 30000 x 4000 m", "millimetres", "40 x 30 x 4 m", "--world-scale 0.001"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace spelunk::evaluation
