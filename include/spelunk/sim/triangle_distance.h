#pragma once

#include <Eigen/Geometry>
#include <array>

namespace spelunk::sim {

/// Three corners in any order; may be degenerate.
using Triangle = std::array<Eigen::Vector3d, 3>;

/// Squared distance from a point to the nearest point of a triangle.
double pointTriangleDistanceSquared(const Eigen::Vector3d& point, const Triangle& triangle);

/// Squared distance between a triangle and the solid axis-aligned box of half extents
/// `half_extents` around the origin; 0 if they meet.
double boxTriangleDistanceSquared(const Eigen::Vector3d& half_extents, const Triangle& triangle);

}  // namespace spelunk::sim
