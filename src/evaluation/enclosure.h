#pragma once

#include <Eigen/Core>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// How often the mesh surrounds a point: the solid angle of all triangles over that of a sphere,
/// +-1 inside a closed mesh whose triangles face one way, 0 outside, between them near a hole
/// (Jacobson, Kavan and Sorkine-Hornung, Robust Inside-Outside Segmentation using Generalized
/// Winding Numbers, ACM Transactions on Graphics 32(4), 2013).
[[nodiscard]] double windingNumber(const sim::WorldMesh& mesh, const Eigen::Vector3d& point);

/// Whether the mesh surrounds a point more than half.
[[nodiscard]] bool isSurrounded(const sim::WorldMesh& mesh, const Eigen::Vector3d& point);

/// Whether an even number of triangles meets at every edge: the mesh has no border.
[[nodiscard]] bool isClosed(const sim::WorldMesh& mesh);

/// Whether a closed surface surrounds a point: no ray from it leaves the mesh.
[[nodiscard]] bool isEnclosed(const sim::WorldMesh& mesh, const Eigen::Vector3d& point);

}  // namespace spelunk::evaluation
