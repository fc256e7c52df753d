#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// Values on a regular grid, x fastest; negative is free space, the outermost layer is rock.
struct ScalarGrid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double cell_m = 1.0;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::vector<float> values;

  [[nodiscard]] std::size_t offsetOf(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(y) +
                static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(z));
  }
  [[nodiscard]] Eigen::Vector3d pointAt(int x, int y, int z) const {
    return origin + cell_m * Eigen::Vector3d(x, y, z);
  }
};

/// Frees single grid points until free and solid corners of each cell hang together: then one
/// surface patch runs through each cell and every edge of its net has two triangles.
void makeManifold(ScalarGrid& grid);

/// Fills every free part that does not hang together with the grid point nearest to `seed`.
void keepConnected(ScalarGrid& grid, const Eigen::Vector3d& seed);

/// The zero surface (naive surface nets: Gibson, "Constrained elastic surface nets", MICCAI 1998,
/// without relaxation): one vertex a cell at the mean of its edge crossings, one quad an edge of
/// the grid with a change of sign. Normals point to the free side.
[[nodiscard]] WorldMesh surfaceOf(const ScalarGrid& grid);

}  // namespace spelunk::sim
