#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <utility>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::test {

/// Edges that are not shared by exactly two triangles that pass them in opposite directions.
inline int openEdges(const sim::WorldMesh& mesh) {
  std::map<std::pair<int, int>, int> passes;
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++passes[{triangle[k], triangle[(k + 1) % 3]}];
  int open = 0;
  for (const auto& [edge, count] : passes) {
    const auto opposite = passes.find({edge.second, edge.first});
    if (count != 1 || opposite == passes.end()) ++open;
  }
  return open;
}

/// Volume enclosed by a closed mesh; positive if its normals point inwards.
inline double enclosedVolume(const sim::WorldMesh& mesh) {
  double six_volumes = 0.0;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const auto corner = [&](int k) {
      return Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(triangle[k])].cast<double>());
    };
    six_volumes -= corner(0).dot(corner(1).cross(corner(2)));
  }
  return six_volumes / 6.0;
}

/// FNV-1a over the bits of all vertices and triangles.
inline std::uint64_t hashOf(const sim::WorldMesh& mesh) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  const auto mix = [&hash](std::uint32_t word) {
    for (int byte = 0; byte < 4; ++byte)
      hash = (hash ^ (word >> (8 * byte) & 0xFFU)) * 0x100000001B3ULL;
  };
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    for (int k = 0; k < 3; ++k) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &vertex[k], sizeof bits);
      mix(bits);
    }
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) mix(static_cast<std::uint32_t>(triangle[k]));
  return hash;
}

}  // namespace spelunk::test
