#include "spelunk/common/path.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk {
namespace {

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  return {a.position + fraction * (b.position - a.position),
          wrapAngle(a.yaw + fraction * wrapAngle(b.yaw - a.yaw))};
}

}  // namespace

double lengthOf(const Path& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += distance(path[i - 1], path[i]);
  return length;
}

Pose poseAt(const Path& path, double arc_m) {
  require(!path.empty(), "poseAt: empty path");
  if (arc_m <= 0.0) return path.front();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double segment = distance(path[i - 1], path[i]);
    if (arc_m < segment) return interpolate(path[i - 1], path[i], arc_m / segment);
    arc_m -= segment;
  }
  return path.back();
}

Path slice(const Path& path, double from_m, double to_m) {
  require(!path.empty(), "slice: empty path");
  Path part{poseAt(path, from_m)};
  double arc = 0.0;
  for (std::size_t i = 1; i < path.size() && arc < to_m; ++i) {
    const double next = arc + distance(path[i - 1], path[i]);
    if (next > from_m && next < to_m) part.push_back(path[i]);
    arc = next;
  }
  if (to_m > from_m) part.push_back(poseAt(path, to_m));
  return part;
}

Path resampled(const Path& path, double spacing_m) {
  require(spacing_m > 0.0, "resampled: spacing must be positive");
  if (path.size() < 2) return path;
  Path dense{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int parts =
        std::max(1, static_cast<int>(std::ceil(distance(path[i - 1], path[i]) / spacing_m - 1e-9)));
    for (int k = 1; k <= parts; ++k)
      dense.push_back(
          k == parts ? path[i] : interpolate(path[i - 1], path[i], static_cast<double>(k) / parts));
  }
  return dense;
}

Path reversed(const Path& path) { return Path(path.rbegin(), path.rend()); }

Path joined(Path path, const Path& more) {
  constexpr double kSamePlace_m = 1e-6;
  for (const Pose& pose : more)
    if (path.empty() || distance(path.back(), pose) > kSamePlace_m) path.push_back(pose);
  return path;
}

PathProjection project(const Path& path, const Eigen::Vector3d& point) {
  require(!path.empty(), "project: empty path");
  PathProjection best{0.0, (path.front().position - point).norm()};
  double arc = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector3d segment = path[i].position - path[i - 1].position;
    const double length = segment.norm();
    if (length <= 0.0) continue;
    const double along =
        std::clamp((point - path[i - 1].position).dot(segment) / length, 0.0, length);
    const double gap = (path[i - 1].position + along / length * segment - point).norm();
    if (gap < best.distance_m) best = {arc + along, gap};
    arc += length;
  }
  return best;
}

}  // namespace spelunk
