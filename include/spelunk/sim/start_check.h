#pragma once

#include <Eigen/Core>
#include <string>

#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// "(x, y, z)" for messages, to the millimetre.
[[nodiscard]] std::string textOf(const Eigen::Vector3d& position);
/// The same of a place in the frame of the mesh, in the world frame.
[[nodiscard]] std::string textOf(const Eigen::Vector3d& position, const WorldMesh& mesh);

/// Throws OutsideError if `start` is not finite or outside the mesh's bounds.
void requireInside(const WorldMesh& mesh, const Pose& start);

/// Throws OutsideError if an axis-aligned box of `size_m` around `position` meets the mesh;
/// `size_key` is the parameter that sets its size.
void requireFreeBody(const MeshScene& scene, const WorldMesh& mesh, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& size_m, const std::string& size_key);

}  // namespace spelunk::sim
