#pragma once

#include <optional>
#include <string>

#include "spelunk/evaluation/voxel_grid.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// The flood leaves the mesh's bounds. What it can reach within the bounds counts as reachable.
struct Leak {
  /// On the shortest way out: where it passes from inside the mesh to outside; where it leaves the
  /// bounds if the mesh does not say what is inside.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  bool is_start_inside = true;  ///< The triangles surround the start and face one way.
};

/// What there is to explore, from the true mesh.
struct ReachableVolume {
  double free_m3 = 0.0;     ///< Voxels free of the mesh and joined to the start (6 neighbours).
  double surface_m3 = 0.0;  ///< Voxels the mesh meets that touch one of those (26 neighbours).
  double total_m3 = 0.0;
  std::optional<Leak> leak;
};

/// The voxels behind those volumes.
struct ReachableSpace {
  VoxelGrid free;
  VoxelGrid surface;  ///< Only what touches free ones.
  std::size_t free_voxels = 0;
  std::size_t surface_voxels = 0;
  std::optional<Leak> leak;
  bool is_enclosed = false;  ///< A closed surface surrounds the start: no ray leaves it.
};

/// Flood fill from `start` at `resolution_m` within the mesh's bounds. Voxels that a triangle runs
/// through are surface; a triangle on the border of two voxels parts them, and one of them is
/// free if it can be reached. A closed mesh does not leak wherever its walls lie. Throws
/// OutsideError if the mesh is too large for the resolution, or if the start lies outside or no
/// free voxel beside it can be seen from it.
[[nodiscard]] ReachableSpace reachableSpace(const sim::WorldMesh& mesh,
                                            const Eigen::Vector3d& start,
                                            double resolution_m = 0.2);

/// The volumes of a space.
[[nodiscard]] ReachableVolume volumeOf(const ReachableSpace& space);

/// Both in one.
[[nodiscard]] ReachableVolume reachableVolume(const sim::WorldMesh& mesh,
                                              const Eigen::Vector3d& start,
                                              double resolution_m = 0.2);

/// A sentence for the log: which mesh leaks, where, and what that means for the figures.
[[nodiscard]] std::string textOf(const Leak& leak, const std::string& mesh_name);

}  // namespace spelunk::evaluation
