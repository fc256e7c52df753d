#include "spelunk/sim/triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

/// Squared distance between the segments p + s * d and q + t * e, s and t in [0, 1].
double segmentDistanceSquared(const Vector3d& p, const Vector3d& d, const Vector3d& q,
                              const Vector3d& e) {
  const Vector3d r = p - q;
  const double dd = d.dot(d);
  const double ee = e.dot(e);
  const double de = d.dot(e);
  const double dr = d.dot(r);
  const double er = e.dot(r);
  const double det = dd * ee - de * de;
  double s = det > 1e-15 * dd * ee ? std::clamp((de * er - dr * ee) / det, 0.0, 1.0) : 0.0;
  double t = ee > 0.0 ? (de * s + er) / ee : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = dd > 0.0 ? std::clamp((de * t - dr) / dd, 0.0, 1.0) : 0.0;
  }
  return (r + s * d - t * e).squaredNorm();
}

/// Whether the projections on `axis` of a triangle and of the box of half extents `half` around the
/// origin lie apart.
bool separates(const Vector3d& axis, const Triangle& triangle, const Vector3d& half) {
  const double reach = half.dot(axis.cwiseAbs());
  const double a = axis.dot(triangle[0]);
  const double b = axis.dot(triangle[1]);
  const double c = axis.dot(triangle[2]);
  return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
}

/// Separating axes: 3 faces of the box, the triangle's plane, 9 products of edges.
bool overlaps(const Triangle& triangle, const Vector3d& half) {
  const std::array<Vector3d, 3> edges{triangle[1] - triangle[0], triangle[2] - triangle[1],
                                      triangle[0] - triangle[2]};
  if (separates(edges[0].cross(edges[1]), triangle, half)) return false;
  for (int k = 0; k < 3; ++k) {
    const Vector3d unit = Vector3d::Unit(k);
    if (separates(unit, triangle, half)) return false;
    for (const Vector3d& edge : edges)
      if (separates(unit.cross(edge), triangle, half)) return false;
  }
  return true;
}

Vector3d boxCorner(const Vector3d& half, int index) {
  return {(index & 1) != 0 ? half.x() : -half.x(), (index & 2) != 0 ? half.y() : -half.y(),
          (index & 4) != 0 ? half.z() : -half.z()};
}

double edgesDistanceSquared(const Triangle& triangle, const Vector3d& half) {
  double best = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d from = boxCorner(half, corner);
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner & (1 << axis)) != 0) continue;  // each edge once, from its lower end
      const Vector3d edge = Vector3d::Unit(axis) * 2.0 * half[axis];
      for (std::size_t k = 0; k < 3; ++k)
        best = std::min(best, segmentDistanceSquared(
                                  triangle[k], triangle[(k + 1) % 3] - triangle[k], from, edge));
    }
  }
  return best;
}

}  // namespace

double pointTriangleDistanceSquared(const Vector3d& point, const Triangle& triangle) {
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double area_squared = normal.squaredNorm();
  bool is_above = area_squared > 0.0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d edge = triangle[(k + 1) % 3] - triangle[k];
    const Vector3d offset = point - triangle[k];
    is_above = is_above && normal.dot(edge.cross(offset)) >= 0.0;
    const double length_squared = edge.squaredNorm();
    const double s =
        length_squared > 0.0 ? std::clamp(edge.dot(offset) / length_squared, 0.0, 1.0) : 0.0;
    best = std::min(best, (offset - s * edge).squaredNorm());
  }
  if (!is_above) return best;
  const double height = normal.dot(point - triangle[0]);
  return height * height / area_squared;
}

double boxTriangleDistanceSquared(const Vector3d& half_extents, const Triangle& triangle) {
  if (overlaps(triangle, half_extents)) return 0.0;
  double best = edgesDistanceSquared(triangle, half_extents);
  for (int corner = 0; corner < 8; ++corner)
    best = std::min(best, pointTriangleDistanceSquared(boxCorner(half_extents, corner), triangle));
  for (const Vector3d& vertex : triangle) {
    const Vector3d outside = (vertex.cwiseAbs() - half_extents).cwiseMax(0.0);
    best = std::min(best, outside.squaredNorm());
  }
  return best;
}

}  // namespace spelunk::sim
