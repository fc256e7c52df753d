#include "scan_tracer.h"

#include <octomap/octomap_types.h>

#include <limits>

namespace spelunk::map {
namespace {

octomap::point3d toOctomap(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

/// Sets one axis of a walk, lengths in metres. The arithmetic (float directions, double sums, voxel
/// border rounded through float) is that of OcTree::computeRayKeys.
void setAxis(int axis, float direction, float origin, double resolution, int key, RayWalk& walk) {
  if (direction == 0.0F) {
    walk.next[axis] = walk.spacing[axis] = std::numeric_limits<double>::max();
    walk.step[axis] = 0;
    return;
  }
  const int sign = direction > 0.0F ? 1 : -1;
  double border = (static_cast<double>(key - kKeyOffset) + 0.5) * resolution;
  border += static_cast<float>(sign * resolution * 0.5);
  walk.next[axis] = (border - origin) / direction;
  walk.spacing[axis] = resolution / std::fabs(static_cast<double>(direction));
  walk.step[axis] = sign;
}

}  // namespace

ScanTracer::ScanTracer(const Eigen::Vector3f& origin, double resolution_m, double range_max_m)
    : origin_(origin),
      resolution_m_(resolution_m),
      inverse_resolution_(1.0 / resolution_m),
      range_max_m_(range_max_m),
      origin_index_(indexOf(origin)) {}

VoxelIndex ScanTracer::indexOf(const Eigen::Vector3f& point) const {
  return voxelOf(point.cast<double>(), inverse_resolution_);
}

PackedKey ScanTracer::keyOf(const Eigen::Vector3f& point) const {
  return packIndex(indexOf(point));
}

Eigen::Vector3f ScanTracer::centreAround(const Eigen::Vector3f& point) const {
  const VoxelIndex index = indexOf(point);
  return ((index.cast<double>().array() + 0.5) * resolution_m_).cast<float>();
}

void ScanTracer::add(const Eigen::Vector3f& end, ScanMarks& marks) {
  const octomap::point3d from = toOctomap(origin_);
  const octomap::point3d difference = toOctomap(end) - from;
  if (difference.norm() <= range_max_m_) {
    addWalk(end);
    marks.markHit(keyOf(end));
    return;
  }
  const octomap::point3d cut = from + difference.normalized() * static_cast<float>(range_max_m_);
  addWalk({cut.x(), cut.y(), cut.z()});
}

void ScanTracer::addWalk(const Eigen::Vector3f& end) {
  RayWalk walk;
  walk.end = indexOf(end);
  if (walk.end == origin_index_) return;
  octomap::point3d direction = toOctomap(end) - toOctomap(origin_);
  const auto length = static_cast<float>(direction.norm());
  direction /= length;
  walk.length = length;
  walk.start = origin_index_;
  for (int axis = 0; axis < 3; ++axis)
    setAxis(axis, direction(static_cast<unsigned>(axis)), origin_(axis), resolution_m_,
            origin_index_(axis) + kKeyOffset, walk);
  walks_.push_back(walk);
}

}  // namespace spelunk::map
