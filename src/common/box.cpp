#include "spelunk/common/box.h"

#include <algorithm>
#include <cmath>

namespace spelunk {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool isOnSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  if (std::abs(cross(b - a, p - a)) > 1e-12 * (1.0 + (b - a).norm())) return false;
  return (p - a).dot(p - b) <= 0.0;
}

bool polygonContains(const Polygon& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[j];
    if (isOnSegment(p, a, b)) return true;
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

bool segmentsMeet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                  const Eigen::Vector2d& d) {
  if (isOnSegment(a, c, d) || isOnSegment(b, c, d) || isOnSegment(c, a, b) || isOnSegment(d, a, b))
    return true;
  return (cross(b - a, c - a) > 0.0) != (cross(b - a, d - a) > 0.0) &&
         (cross(d - c, a - c) > 0.0) != (cross(d - c, b - c) > 0.0);
}

/// The convex outline a rectangle of half extents `half` leaves when its centre moves a -> b.
Polygon sweptRectangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& half) {
  Polygon corners;
  for (const Eigen::Vector2d& centre : {a, b})
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0})
        corners.emplace_back(centre + Eigen::Vector2d(sx * half.x(), sy * half.y()));
  std::sort(corners.begin(), corners.end(), [](const auto& p, const auto& q) {
    return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
  });
  Polygon outline;  // Andrew's monotone chain
  for (const int pass : {0, 1}) {
    const std::size_t start = outline.size();
    for (const Eigen::Vector2d& p : corners) {
      while (outline.size() >= start + 2 &&
             cross(outline.back() - outline[outline.size() - 2], p - outline.back()) <= 0.0)
        outline.pop_back();
      outline.push_back(p);
    }
    outline.pop_back();
    if (pass == 0) std::reverse(corners.begin(), corners.end());
  }
  return outline;
}

bool polygonsMeet(const Polygon& p, const Polygon& q) {
  if (polygonContains(p, q.front()) || polygonContains(q, p.front())) return true;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < q.size(); ++j)
      if (segmentsMeet(p[i], p[(i + 1) % p.size()], q[j], q[(j + 1) % q.size()])) return true;
  return false;
}

/// Whether the bounds of the polygon and of the swept rectangle are apart: most zones are far off.
bool liesBeside(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                const Eigen::Vector2d& half) {
  Eigen::Vector2d low = polygon.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& corner : polygon) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Eigen::Vector2d first = a.cwiseMin(b) - half;
  const Eigen::Vector2d last = a.cwiseMax(b) + half;
  return (low.array() > last.array()).any() || (high.array() < first.array()).any();
}

}  // namespace

AxisAlignedBox intersection(const AxisAlignedBox& a, const AxisAlignedBox& b) {
  return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)};
}

AxisAlignedBox boxAround(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  return {centre - 0.5 * size, centre + 0.5 * size};
}

AxisAlignedBox hull(const AxisAlignedBox& a, const AxisAlignedBox& b) {
  return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
}

bool contains(const NoGoZone& zone, const Eigen::Vector3d& point) {
  return zone.polygon.size() >= 3 && point.z() >= zone.z_min && point.z() <= zone.z_max &&
         polygonContains(zone.polygon, point.head<2>());
}

bool sweptBoxMeets(const NoGoZone& zone, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& box_size) {
  if (zone.polygon.size() < 3) return false;
  const double half_height = 0.5 * box_size.z();
  if (std::max(a.z(), b.z()) + half_height < zone.z_min) return false;
  if (std::min(a.z(), b.z()) - half_height > zone.z_max) return false;
  const Eigen::Vector2d half = 0.5 * box_size.head<2>();
  if (liesBeside(zone.polygon, a.head<2>(), b.head<2>(), half)) return false;
  return polygonsMeet(sweptRectangle(a.head<2>(), b.head<2>(), half), zone.polygon);
}

}  // namespace spelunk
