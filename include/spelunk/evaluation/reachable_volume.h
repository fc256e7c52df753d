#pragma once

#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// What there is to explore, from the true mesh.
struct ReachableVolume {
  double free_m3 = 0.0;     ///< Voxels free of the mesh and joined to the start (6 neighbours).
  double surface_m3 = 0.0;  ///< Voxels the mesh meets that touch one of those (26 neighbours).
  double total_m3 = 0.0;
  bool leaks = false;  ///< The flood reached the border of the mesh's bounds.
};

/// Flood fill from `start` at `resolution_m`; voxels that a triangle meets (separating axes, exact
/// up to rounding) are surface. Throws OutsideError if the start lies outside or in a surface
/// voxel.
[[nodiscard]] ReachableVolume reachableVolume(const sim::WorldMesh& mesh,
                                              const Eigen::Vector3d& start,
                                              double resolution_m = 0.2);

}  // namespace spelunk::evaluation
