#pragma once

#include <Eigen/Core>

#include "mesh_voxels.h"
#include "spelunk/evaluation/reachable_volume.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// Where the space joined to the voxel `start` leaks, which it must.
[[nodiscard]] Leak findLeak(const sim::WorldMesh& mesh, const MeshVoxels& voxels,
                            const Eigen::Vector3i& start);

}  // namespace spelunk::evaluation
