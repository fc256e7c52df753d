#include "spelunk/navigation/swept_path_check.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::navigation {
namespace {

PathFault faultOf(map::Occupancy occupancy) {
  if (occupancy == map::Occupancy::kFree) return PathFault::kNone;
  return occupancy == map::Occupancy::kOccupied ? PathFault::kOccupied : PathFault::kUnknown;
}

/// How far the box gets on a segment whose whole sweep is not free.
double freeLength(map::ConfigurationSpace& space, const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b) {
  const double length = (b - a).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / space.resolution())));
  Eigen::Vector3d last = a;
  if (!space.isFree(a)) return 0.0;
  for (int k = 1; k <= steps; ++k) {
    const Eigen::Vector3d next = a + (b - a) * (static_cast<double>(k) / steps);
    if (!space.isSweepFree(last, next)) return length * (k - 1) / steps;
    last = next;
  }
  return 0.0;
}

const NoGoZone* findZone(const std::vector<NoGoZone>& zones, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b, const Eigen::Vector3d& box) {
  const auto met = std::find_if(zones.begin(), zones.end(), [&](const NoGoZone& zone) {
    return sweptBoxMeets(zone, a, b, box);
  });
  return met == zones.end() ? nullptr : &*met;
}

/// The fault of one segment with `arc_m` counted from its begin.
PathCheck checkSegment(map::ConfigurationSpace& space, const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b, const std::vector<NoGoZone>& zones,
                       const AxisAlignedBox& bounds) {
  if (!bounds.contains(a) || !bounds.contains(b)) return {PathFault::kOutOfBounds, 0.0, ""};
  if (const NoGoZone* zone = findZone(zones, a, b, space.boxSize()))
    return {PathFault::kNoGo, 0.0, zone->name};
  const PathFault fault = faultOf(space.sweep(a, b));
  return {fault, fault == PathFault::kNone ? 0.0 : freeLength(space, a, b), ""};
}

}  // namespace

const char* toText(PathFault fault) {
  switch (fault) {
    case PathFault::kNone:
      return "free";
    case PathFault::kOccupied:
      return "occupied";
    case PathFault::kUnknown:
      return "unknown";
    case PathFault::kOutOfBounds:
      return "out of bounds";
    case PathFault::kNoGo:
      return "no-go zone";
  }
  return "unknown";
}

PathCheck checkPath(map::ConfigurationSpace& space, const Path& path,
                    const std::vector<NoGoZone>& zones, const AxisAlignedBox& bounds) {
  require(!path.empty(), "checkPath: empty path");
  double arc = 0.0;
  for (std::size_t i = path.size() == 1 ? 0 : 1; i < path.size(); ++i) {
    const Eigen::Vector3d& a = path[i == 0 ? 0 : i - 1].position;
    const Eigen::Vector3d& b = path[i].position;
    PathCheck found = checkSegment(space, a, b, zones, bounds);
    if (!found.isFree()) {
      found.arc_m += arc;
      return found;
    }
    arc += (b - a).norm();
  }
  return {PathFault::kNone, arc, ""};
}

}  // namespace spelunk::navigation
