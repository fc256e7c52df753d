#include "spelunk/planners/gbplanner/improve_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "spelunk/common/box.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::Polyline;
using Polygon = std::vector<Eigen::Vector2d>;

constexpr int kPlanesMax = 50;  // the paper: fewer than 50 iterations in practice

struct Halfspace {  // normal . point <= offset is inside
  Eigen::Vector3d normal;
  double offset = 0.0;
};

/// Coordinates along an edge and across it.
struct EdgeFrame {
  Eigen::Vector3d middle;
  std::array<Eigen::Vector3d, 3> axes;  // along, left, up
  double half_length = 0.0;

  EdgeFrame(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
      : middle(0.5 * (a + b)), half_length(0.5 * (b - a).norm()) {
    const Eigen::Vector3d along = (b - a).normalized();
    constexpr double kSteep = 0.99;
    const Eigen::Vector3d helper = std::abs(along.z()) < kSteep ? Eigen::Vector3d::UnitZ().eval()
                                                                : Eigen::Vector3d::UnitX().eval();
    const Eigen::Vector3d left = helper.cross(along).normalized();
    axes = {along, left, along.cross(left)};
  }

  [[nodiscard]] Eigen::Vector3d local(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d d = point - middle;
    return {d.dot(axes[0]), d.dot(axes[1]), d.dot(axes[2])};
  }
};

/// Occupied voxel centres near an edge, in the edge's frame.
std::vector<Eigen::Vector3d> obstaclesNear(const EdgeFrame& frame, const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b, const map::FrozenMap& map,
                                           double radius_m) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m);
  std::vector<Eigen::Vector3d> obstacles;
  map.forEachOccupied(
      {a.cwiseMin(b) - reach, a.cwiseMax(b) + reach}, [&](const map::VoxelIndex& voxel) {
        const Eigen::Vector3d local = frame.local(map.centreOf(voxel));
        const bool is_near = std::abs(local.x()) <= frame.half_length + radius_m &&
                             local.tail<2>().squaredNorm() <= 2.0 * radius_m * radius_m;
        if (is_near) obstacles.push_back(local);
      });
  return obstacles;
}

/// Inflates the ellipsoid about the edge: the nearest obstacle in its metric gives a tangent plane
/// and hides all obstacles behind that plane.
std::vector<Halfspace> tangentPlanes(std::vector<Eigen::Vector3d> obstacles, double half_length,
                                     double radius_m) {
  // The shape is fixed by its half axes, so inflating it is one scale: the smallest one that meets
  // an obstacle comes first.
  const Eigen::Vector3d half_axes(half_length + 0.5 * radius_m, radius_m, radius_m);
  const Eigen::Vector3d inverse_squared = half_axes.cwiseProduct(half_axes).cwiseInverse();
  std::vector<Halfspace> planes;
  while (!obstacles.empty() && planes.size() < kPlanesMax) {
    const auto nearest =
        std::min_element(obstacles.begin(), obstacles.end(), [&](const auto& p, const auto& q) {
          return p.cwiseProduct(p).dot(inverse_squared) < q.cwiseProduct(q).dot(inverse_squared);
        });
    const Eigen::Vector3d normal = nearest->cwiseProduct(inverse_squared).normalized();
    const Halfspace plane{normal, normal.dot(*nearest)};
    planes.push_back(plane);
    obstacles.erase(std::remove_if(obstacles.begin(), obstacles.end(),
                                   [&](const Eigen::Vector3d& p) {
                                     return plane.normal.dot(p) >= plane.offset - 1e-9;
                                   }),
                    obstacles.end());
  }
  return planes;
}

/// The part of a convex polygon where normal . p <= offset.
Polygon clipped(const Polygon& polygon, const Eigen::Vector2d& normal, double offset) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = normal.dot(p) - offset;
    const double at_q = normal.dot(q) - offset;
    if (at_p <= 0.0) inside.push_back(p);
    if ((at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0))
      inside.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return inside;
}

Eigen::Vector2d centroidOf(const Polygon& polygon) {
  double area = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double cross = p.x() * q.y() - p.y() * q.x();
    area += cross;
    sum += (p + q) * cross;
  }
  constexpr double kSliver = 1e-9;
  return std::abs(area) < kSliver ? polygon.front() : Eigen::Vector2d(sum / (3.0 * area));
}

bool fits(const Polyline& path, std::size_t i, const Eigen::Vector3d& moved,
          const FreeSpace& space) {
  return space.isFree(path[i - 1], moved) &&
         (i + 1 == path.size() || space.isFree(moved, path[i + 1]));
}

}  // namespace

Polyline shortened(const Polyline& path, const FreeSpace& space, double segment_length_max_m) {
  if (path.size() < 3) return path;
  Polyline shorter{path.front()};
  for (std::size_t i = 0; i + 1 < path.size();) {
    std::size_t next = i + 1;
    for (std::size_t j = path.size() - 1; j > i + 1; --j) {
      if ((path[j] - path[i]).norm() > segment_length_max_m) continue;
      if (!space.isFree(path[i], path[j])) continue;
      next = j;
      break;
    }
    shorter.push_back(path[next]);
    i = next;
  }
  return shorter;
}

Polyline pruned(const Polyline& path, const FreeSpace& space, double length_m) {
  if (path.size() < 3) return path;
  Polyline kept{path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const bool is_short = (path[i] - kept.back()).norm() < length_m;
    if (is_short && space.isFree(kept.back(), path[i + 1])) continue;
    kept.push_back(path[i]);
  }
  kept.push_back(path.back());
  return kept;
}

Eigen::Vector3d roomiestPoint(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const map::FrozenMap& map, double radius_m) {
  constexpr double kNoLength = 1e-6;
  if ((b - a).norm() < kNoLength) return b;
  const EdgeFrame frame(a, b);
  const std::vector<Halfspace> planes =
      tangentPlanes(obstaclesNear(frame, a, b, map, radius_m), frame.half_length, radius_m);
  Polygon polygon{
      {-radius_m, -radius_m}, {radius_m, -radius_m}, {radius_m, radius_m}, {-radius_m, radius_m}};
  for (const Halfspace& plane : planes) {
    const double offset = plane.offset - plane.normal.x() * frame.half_length;  // at vertex b
    polygon = clipped(polygon, plane.normal.tail<2>(), offset);
    if (polygon.size() < 3) return b;
  }
  const Eigen::Vector2d centre = centroidOf(polygon);
  return b + frame.axes[1] * centre.x() + frame.axes[2] * centre.y();
}

Polyline improvedPath(const Polyline& path, const FreeSpace& space, const map::FrozenMap& map,
                      const ImproveLimits& limits) {
  Polyline improved =
      pruned(shortened(path, space, limits.shortcut_length_max_m), space, limits.prune_length_m);
  for (std::size_t i = 1; i < improved.size(); ++i) {
    const Eigen::Vector3d centre =
        roomiestPoint(improved[i - 1], improved[i], map, limits.inflation_radius_m);
    for (const double share : {1.0, 0.5}) {
      const auto moved =
          space.placed(improved[i] + share * (centre - improved[i]), improved[i - 1]);
      if (!moved || !fits(improved, i, *moved, space)) continue;
      improved[i] = *moved;
      break;
    }
  }
  return improved;
}

}  // namespace spelunk::planners::gbplanner
