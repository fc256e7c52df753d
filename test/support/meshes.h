#pragma once

#include <Eigen/Core>
#include <utility>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::test {

/// Adds the 12 triangles of an axis-aligned box's surface.
inline void addBox(sim::WorldMesh& mesh, const Eigen::Vector3f& min, const Eigen::Vector3f& max) {
  const int base = static_cast<int>(mesh.vertices.size());
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back((k & 1) != 0 ? max.x() : min.x(), (k & 2) != 0 ? max.y() : min.y(),
                               (k & 4) != 0 ? max.z() : min.z());
  constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const auto& face : kFaces) {
    mesh.triangles.emplace_back(base + face[0], base + face[1], base + face[2]);
    mesh.triangles.emplace_back(base + face[0], base + face[2], base + face[3]);
  }
}

/// A room seen from inside: floor at z = 0, centred at the origin, full extents `size_m`.
inline sim::WorldMesh boxRoom(const Eigen::Vector3f& size_m) {
  sim::WorldMesh mesh;
  mesh.name = "box_room";
  addBox(mesh, {-0.5F * size_m.x(), -0.5F * size_m.y(), 0.0F},
         {0.5F * size_m.x(), 0.5F * size_m.y(), size_m.z()});
  return mesh;
}

/// A corridor from x = 0 to `length_m` (walls at y = +-width/2, ceiling at 3 m) with a square
/// pillar of 0.5 m halfway.
inline sim::WorldMesh corridorWithPillar(float length_m, float width_m) {
  sim::WorldMesh mesh;
  mesh.name = "corridor";
  addBox(mesh, {0.0F, -0.5F * width_m, 0.0F}, {length_m, 0.5F * width_m, 3.0F});
  const float middle = 0.5F * length_m;
  addBox(mesh, {middle - 0.25F, -0.25F, 0.0F}, {middle + 0.25F, 0.25F, 3.0F});
  return mesh;
}

}  // namespace spelunk::test
