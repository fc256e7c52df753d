#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// Collects triangles, so that rays, physics and truth see the same ones. Vertices of equal
/// coordinates get one index, in order of appearance; those of no kept triangle get none.
class MeshBuilder {
 public:
  explicit MeshBuilder(WorldMesh& mesh) : mesh_(mesh) {}

  /// Leaves out what has no area within the rounding of its vertices (rays pass it, bodies would
  /// collide with it) and what lies on the same three vertices as another one.
  void addTriangle(const std::array<Eigen::Vector3f, 3>& corners);

  [[nodiscard]] std::size_t flat() const { return flat_; }          ///< Left out: no area.
  [[nodiscard]] std::size_t repeated() const { return repeated_; }  ///< Left out: twice there.
  /// Left out: a vertex is not finite.
  [[nodiscard]] std::size_t broken() const { return broken_; }

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct BitsHash {
    std::size_t operator()(const Bits& bits) const;
  };

  int indexOf(const Eigen::Vector3f& vertex);

  WorldMesh& mesh_;
  std::unordered_map<Bits, int, BitsHash> index_;
  std::unordered_set<Bits, BitsHash> corners_;  ///< Of the triangles, ascending.
  std::size_t flat_ = 0;
  std::size_t repeated_ = 0;
  std::size_t broken_ = 0;
};

}  // namespace spelunk::sim
