#pragma once

#include "spelunk/evaluation/voxel_grid.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// What there is to explore, from the true mesh.
struct ReachableVolume {
  double free_m3 = 0.0;     ///< Voxels free of the mesh and joined to the start (6 neighbours).
  double surface_m3 = 0.0;  ///< Voxels the mesh meets that touch one of those (26 neighbours).
  double total_m3 = 0.0;
  bool leaks = false;  ///< The flood reached the border of the mesh's bounds.
};

/// The voxels behind those volumes.
struct ReachableSpace {
  VoxelGrid free;
  VoxelGrid surface;  ///< Only what touches free ones.
  std::size_t free_voxels = 0;
  std::size_t surface_voxels = 0;
  bool leaks = false;
};

/// Flood fill from `start` at `resolution_m`; voxels that a triangle meets (separating axes, exact
/// up to rounding) are surface. Throws OutsideError if the start lies outside or in a surface
/// voxel.
[[nodiscard]] ReachableSpace reachableSpace(const sim::WorldMesh& mesh,
                                            const Eigen::Vector3d& start,
                                            double resolution_m = 0.2);

/// The same, only its volumes.
[[nodiscard]] ReachableVolume reachableVolume(const sim::WorldMesh& mesh,
                                              const Eigen::Vector3d& start,
                                              double resolution_m = 0.2);

}  // namespace spelunk::evaluation
