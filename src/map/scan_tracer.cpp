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

ScanTracer::ScanTracer(const Eigen::Vector3f& origin, double resolution_m, double range_max_m,
                       std::vector<RayWalk>& walks)
    : origin_(origin),
      resolution_m_(resolution_m),
      inverse_resolution_(1.0 / resolution_m),
      range_max_m_(range_max_m),
      origin_index_(indexOf(origin)),
      walks_(walks) {
  walks_.clear();
}

VoxelIndex ScanTracer::indexOf(const Eigen::Vector3f& point) const {
  return voxelOf(point.cast<double>(), inverse_resolution_);
}

Eigen::Vector3f ScanTracer::centreOf(const VoxelIndex& index) const {
  return ((index.cast<double>().array() + 0.5) * resolution_m_).cast<float>();
}

Eigen::Vector3f ScanTracer::centreAround(const Eigen::Vector3f& point) const {
  return centreOf(indexOf(point));
}

void ScanTracer::add(const Eigen::Vector3f& end, ScanMarks& marks) {
  addWithin(end, indexOf(end), marks);
}

void ScanTracer::addOnce(const Eigen::Vector3f& end, ScanMarks& ends, ScanMarks& marks) {
  const VoxelIndex voxel = indexOf(end);
  if (ends.markHit(packIndex(voxel))) addWithin(centreOf(voxel), voxel, marks);
}

void ScanTracer::addWithin(const Eigen::Vector3f& end, const VoxelIndex& voxel, ScanMarks& marks) {
  const octomap::point3d from = toOctomap(origin_);
  const octomap::point3d difference = toOctomap(end) - from;
  if (difference.norm() <= range_max_m_) {
    addWalk(end, voxel);
    marks.markHit(packIndex(voxel));
    return;
  }
  const octomap::point3d cut = from + difference.normalized() * static_cast<float>(range_max_m_);
  const Eigen::Vector3f cut_end(cut.x(), cut.y(), cut.z());
  addWalk(cut_end, indexOf(cut_end));
}

void ScanTracer::addWalk(const Eigen::Vector3f& end, const VoxelIndex& voxel) {
  RayWalk walk;
  walk.end = voxel;
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
