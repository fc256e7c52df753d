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

/// Adds a rectangle across `axis` at `place`; the other two axes, in their order, go from `min` to
/// `max`.
inline void addRectangle(sim::WorldMesh& mesh, int axis, float place, const Eigen::Vector2f& min,
                         const Eigen::Vector2f& max) {
  const int base = static_cast<int>(mesh.vertices.size());
  const int u = axis == 0 ? 1 : 0;
  const int v = axis == 2 ? 1 : 2;
  for (int k = 0; k < 4; ++k) {
    Eigen::Vector3f corner;
    corner[axis] = place;
    corner[u] = k == 1 || k == 2 ? max.x() : min.x();
    corner[v] = k >= 2 ? max.y() : min.y();
    mesh.vertices.push_back(corner);
  }
  mesh.triangles.emplace_back(base, base + 1, base + 2);
  mesh.triangles.emplace_back(base, base + 2, base + 3);
}

/// A gallery from the origin to (40, 5, 3.5) whose end at x = 40 is open to the outside.
inline sim::WorldMesh galleryWithPortal() {
  sim::WorldMesh mesh;
  mesh.name = "gallery_with_portal";
  addBox(mesh, Eigen::Vector3f::Zero(), {40.0F, 5.0F, 3.5F});
  mesh.triangles.resize(mesh.triangles.size() - 2);  // the face at the greatest x comes last
  return mesh;
}

/// A gallery of 4 x 3.5 m along x, open to the outside at x = 40; at x = 24 to 28 a branch leads
/// off to y = 34, where it ends.
inline sim::WorldMesh galleryWithPortalAndBranch() {
  sim::WorldMesh mesh;
  mesh.name = "gallery_with_portal_and_branch";
  constexpr float kHeight = 3.5F;
  addRectangle(mesh, 0, 0.0F, {0.0F, 0.0F}, {4.0F, kHeight});
  addRectangle(mesh, 1, 0.0F, {0.0F, 0.0F}, {40.0F, kHeight});
  addRectangle(mesh, 1, 4.0F, {0.0F, 0.0F}, {24.0F, kHeight});
  addRectangle(mesh, 1, 4.0F, {28.0F, 0.0F}, {40.0F, kHeight});
  addRectangle(mesh, 0, 24.0F, {4.0F, 0.0F}, {34.0F, kHeight});
  addRectangle(mesh, 0, 28.0F, {4.0F, 0.0F}, {34.0F, kHeight});
  addRectangle(mesh, 1, 34.0F, {24.0F, 0.0F}, {28.0F, kHeight});
  for (const float z : {0.0F, kHeight}) {
    addRectangle(mesh, 2, z, {0.0F, 0.0F}, {40.0F, 4.0F});
    addRectangle(mesh, 2, z, {24.0F, 4.0F}, {28.0F, 34.0F});
  }
  return mesh;
}

/// A room seen from inside: floor at z = 0, centred at the origin, full extents `size_m`.
inline sim::WorldMesh boxRoom(const Eigen::Vector3f& size_m) {
  sim::WorldMesh mesh;
  mesh.name = "box_room";
  addBox(mesh, {-0.5F * size_m.x(), -0.5F * size_m.y(), 0.0F},
         {0.5F * size_m.x(), 0.5F * size_m.y(), size_m.z()});
  return mesh;
}

/// A room of 20.2 x 8.3 x 4.1 m with a pillar, which is explored in half a minute.
inline sim::WorldMesh roomWithPillar() {
  sim::WorldMesh room = boxRoom({20.2F, 8.3F, 4.1F});
  addBox(room, {1.3F, -0.7F, 0.0F}, {2.4F, 0.6F, 4.1F});
  return room;
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
