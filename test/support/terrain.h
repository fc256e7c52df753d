#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/sim/rock_noise.h"
#include "spelunk/sim/world_mesh.h"
#include "support/meshes.h"

namespace spelunk::test {

/// Ground along x: (x, z) points of a profile, extruded from y = -width/2 to width/2.
inline sim::WorldMesh profile(const std::vector<Eigen::Vector2f>& points, float width_m) {
  sim::WorldMesh mesh;
  mesh.name = "profile";
  for (const Eigen::Vector2f& point : points)
    for (const float side : {-0.5F, 0.5F})
      mesh.vertices.emplace_back(point.x(), side * width_m, point.y());
  for (int k = 0; k + 1 < static_cast<int>(points.size()); ++k) {
    mesh.triangles.emplace_back(2 * k, 2 * k + 2, 2 * k + 1);
    mesh.triangles.emplace_back(2 * k + 1, 2 * k + 2, 2 * k + 3);
  }
  // Far above, so that starts at flying height are inside the mesh's bounds.
  const int first = static_cast<int>(mesh.vertices.size());
  for (const float x : {points.front().x(), points.back().x()})
    mesh.vertices.emplace_back(x, 0.0F, 30.0F);
  mesh.vertices.emplace_back(points.front().x(), 1.0F, 30.0F);
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  return mesh;
}

/// Flat, up at `degrees` for `run_m`, flat for 3 m, down again, flat. The ramp begins at x = 3.
inline sim::WorldMesh ramp(float degrees, float run_m) {
  const float rise = run_m * std::tan(degrees * static_cast<float>(M_PI) / 180.0F);
  const float top = 3.0F + run_m;
  return profile(
      {{-5, 0}, {3, 0}, {top, rise}, {top + 3, rise}, {top + 3 + run_m, 0}, {top + run_m + 12, 0}},
      8.0F);
}

/// `count` steps up from x = 3, 2 m flat, and the same down again.
inline sim::WorldMesh stairs(float rise_m, float tread_m, int count) {
  std::vector<Eigen::Vector2f> points{{-5, 0}};
  float x = 3.0F;
  float z = 0.0F;
  for (int k = 0; k < 2 * count; ++k) {
    points.emplace_back(x, z);
    z += k < count ? rise_m : -rise_m;
    points.emplace_back(x, z);
    x += k + 1 == count ? 2.0F : tread_m;
  }
  points.emplace_back(x + 8.0F, 0.0F);
  return profile(points, 8.0F);
}

/// Flat ground with one upright step at x = 3 (down if negative).
inline sim::WorldMesh step(float rise_m) {
  return profile({{-5, 0}, {3, 0}, {3, rise_m}, {12, rise_m}}, 8.0F);
}

/// Flat ground with a trench across from x = 3.
inline sim::WorldMesh trench(float depth_m, float width_m) {
  return profile({{-5, 0},
                  {3, 0},
                  {3, -depth_m},
                  {3 + width_m, -depth_m},
                  {3 + width_m, 0},
                  {12 + width_m, 0}},
                 8.0F);
}

/// Flat ground strewn with blocks of up to `height_m`, one a square metre, from x = 1 to 32.
inline sim::WorldMesh rubble(double height_m, std::uint64_t seed) {
  sim::WorldMesh mesh = profile({{-5, 0}, {38, 0}}, 18.0F);
  mesh.name = "rubble";
  Rng rng = Rng(seed).fork("test/rubble");
  for (int k = 0; k < 450; ++k) {
    const Eigen::Vector2d middle(rng.uniform(1.0, 32.0), rng.uniform(-7.0, 7.0));
    const Eigen::Vector2d half(rng.uniform(0.12, 0.3), rng.uniform(0.12, 0.3));
    const Eigen::Vector2f min = (middle - half).cast<float>();
    const Eigen::Vector2f max = (middle + half).cast<float>();
    const auto top = static_cast<float>(rng.uniform(0.05, height_m));
    addBox(mesh, {min.x(), min.y(), -0.3F}, {max.x(), max.y(), top});
  }
  return mesh;
}

/// Ground with bumps and hollows, `height_m` from the lowest to the highest, of 0.6 m and up; flat
/// around x = y = 0.
inline sim::WorldMesh roughGround(float length_m, float width_m, float height_m, unsigned seed) {
  constexpr double kCell = 0.1;
  sim::WorldMesh mesh;
  mesh.name = "rough";
  const int columns = static_cast<int>(length_m / kCell) + 1;
  const int rows = static_cast<int>(width_m / kCell) + 1;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const Eigen::Vector2d at(kCell * i - 5.0, kCell * j - 0.5 * width_m);
      const double noise = 0.6 * sim::rockNoise({at.x(), at.y(), 0.0}, 1.5, seed) +
                           0.4 * sim::rockNoise({at.x(), at.y(), 0.0}, 0.6, seed + 1);
      const double fade = std::min(1.0, std::max(0.0, at.norm() - 1.0));
      mesh.vertices.emplace_back(at.x(), at.y(), height_m * fade * noise);
    }
  for (int i = 0; i + 1 < columns; ++i)
    for (int j = 0; j + 1 < rows; ++j) {
      const int a = i * rows + j;
      mesh.triangles.emplace_back(a, a + rows, a + 1);
      mesh.triangles.emplace_back(a + 1, a + rows, a + rows + 1);
    }
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(-5.0F, 0.0F, 30.0F);
  mesh.vertices.emplace_back(length_m - 5.0F, 0.0F, 30.0F);
  mesh.vertices.emplace_back(-5.0F, 1.0F, 30.0F);
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  return mesh;
}

}  // namespace spelunk::test
