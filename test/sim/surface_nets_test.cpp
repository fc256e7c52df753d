#include "spelunk/sim/surface_nets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"
#include "support/mesh_checks.h"

namespace spelunk::sim {
namespace {

/// Rock everywhere but where `value` says otherwise; the border stays rock.
template <class Value>
ScalarGrid gridOf(int side, double cell_m, Value&& value) {
  ScalarGrid grid;
  grid.cell_m = cell_m;
  grid.size = Eigen::Vector3i::Constant(side);
  grid.values.assign(grid.offsetOf(0, 0, side), 1.0F);
  for (int z = 1; z + 1 < side; ++z)
    for (int y = 1; y + 1 < side; ++y)
      for (int x = 1; x + 1 < side; ++x)
        grid.values[grid.offsetOf(x, y, z)] = static_cast<float>(value(grid.pointAt(x, y, z)));
  return grid;
}

ScalarGrid noiseGrid(std::uint64_t seed, double free_share) {
  Rng rng(seed);
  return gridOf(14, 1.0, [&](const Eigen::Vector3d&) { return rng.uniform() - free_share; });
}

TEST(SurfaceNets, EnclosesTheVolumeOfASphere) {
  const Eigen::Vector3d centre(3.0, 3.1, 2.9);
  const ScalarGrid grid =
      gridOf(25, 0.25, [&](const Eigen::Vector3d& p) { return (p - centre).norm() - 2.0; });
  const WorldMesh mesh = surfaceOf(grid);
  EXPECT_EQ(test::openEdges(mesh), 0);
  EXPECT_NEAR(test::enclosedVolume(mesh), 4.0 / 3.0 * M_PI * 8.0, 0.7);
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    EXPECT_NEAR((vertex.cast<double>() - centre).norm(), 2.0, 0.02);
}

TEST(SurfaceNets, KeepsAFlatWallFlat) {
  const ScalarGrid grid = gridOf(12, 0.5, [](const Eigen::Vector3d& p) { return p.x() - 2.63; });
  int on_the_wall = 0;
  for (const Eigen::Vector3f& vertex : surfaceOf(grid).vertices) {
    const bool is_inner = vertex.y() > 1.1F && vertex.y() < 4.4F && vertex.z() > 1.1F &&
                          vertex.z() < 4.4F && vertex.x() > 1.1F;
    if (!is_inner) continue;
    EXPECT_NEAR(vertex.x(), 2.63, 1e-5);
    ++on_the_wall;
  }
  EXPECT_GT(on_the_wall, 20);
}

TEST(SurfaceNets, AnEmptyGridHasNoSurface) {
  EXPECT_TRUE(
      surfaceOf(gridOf(5, 1.0, [](const Eigen::Vector3d&) { return 1.0; })).triangles.empty());
}

TEST(MakeManifold, ClosesTheNetOfAnyNoise) {
  bool some_net_was_open = false;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    ScalarGrid grid = noiseGrid(seed, 0.1 + 0.01 * static_cast<double>(seed));
    some_net_was_open = some_net_was_open || test::openEdges(surfaceOf(grid)) > 0;
    makeManifold(grid);
    EXPECT_EQ(test::openEdges(surfaceOf(grid)), 0) << "seed " << seed;
  }
  EXPECT_TRUE(some_net_was_open) << "the noise is too tame to test anything";
}

TEST(MakeManifold, OnlyEverFrees) {
  const ScalarGrid before = noiseGrid(5, 0.3);
  ScalarGrid after = before;
  makeManifold(after);
  for (std::size_t i = 0; i < before.values.size(); ++i) {
    if (before.values[i] < 0.0F) {
      EXPECT_EQ(before.values[i], after.values[i]);
    }
  }
}

TEST(MakeManifold, LeavesASmoothFieldAlone) {
  const ScalarGrid before = gridOf(20, 0.5, [](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(4.5, 4.6, 4.4)).norm() - 3;
  });
  ScalarGrid after = before;
  makeManifold(after);
  EXPECT_EQ(before.values, after.values);
}

TEST(KeepConnected, FillsABubbleApart) {
  const Eigen::Vector3d here(3.0, 3.0, 3.0);
  const Eigen::Vector3d there(8.0, 8.0, 8.0);
  const auto two = [&](const Eigen::Vector3d& p) {
    return std::min((p - here).norm() - 1.6, (p - there).norm() - 2.2);
  };
  ScalarGrid grid = gridOf(24, 0.5, two);
  keepConnected(grid, here);
  EXPECT_NEAR(test::enclosedVolume(surfaceOf(grid)), 4.0 / 3.0 * M_PI * std::pow(1.6, 3), 2.0);
}

TEST(KeepConnected, RefusesASeedInRock) {
  ScalarGrid grid = gridOf(
      12, 0.5, [](const Eigen::Vector3d& p) { return (p - Eigen::Vector3d(2, 2, 2)).norm() - 1; });
  EXPECT_THROW(keepConnected(grid, {4.0, 4.0, 4.0}), Precondition);
}

}  // namespace
}  // namespace spelunk::sim
