#include "scan_marks.h"

#include <octomap/octomap_types.h>

#include <limits>

namespace spelunk::map {
namespace {

octomap::point3d toOctomap(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

/// State of the traversal on one axis, in metres along the ray. The arithmetic (float directions,
/// double sums, voxel border rounded through float) is that of OcTree::computeRayKeys.
struct AxisWalk {
  double next_border;
  double border_spacing;
  PackedKey step;  ///< Added to the key; wraps around for steps back.
};

AxisWalk walkOf(int axis, float direction, float origin, double resolution, int key) {
  if (direction == 0.0F) {
    const double never = std::numeric_limits<double>::max();
    return {never, never, 0};
  }
  const int sign = direction > 0.0F ? 1 : -1;
  double border = (static_cast<double>(key - kKeyOffset) + 0.5) * resolution;
  border += static_cast<float>(sign * resolution * 0.5);
  const PackedKey unit = PackedKey{1} << (axis * kKeyFieldBits);
  return {(border - origin) / direction, resolution / std::fabs(static_cast<double>(direction)),
          sign > 0 ? unit : PackedKey{0} - unit};
}

/// Marks the voxels from `key` up to the end as free. All state of the loop is local, so that it
/// stays in registers.
void markWalk(const AxisWalk& x, const AxisWalk& y, const AxisWalk& z, PackedKey key,
              PackedKey end_key, double length, ScanMarks& marks) {
  double next_x = x.next_border;
  double next_y = y.next_border;
  double next_z = z.next_border;
  PackedKey block = ~PackedKey{0};
  std::uint64_t* words = nullptr;
  double limit = std::numeric_limits<double>::infinity();  // the first voxel always counts
  // Marks the voxel and leaves it by its nearest border; false if that lies beyond the ray's end:
  // rounding can lead the walk past the end's voxel.
  const auto leave = [&](double& border, const AxisWalk& axis) {
    if (border > limit) return false;
    if ((key & ~kInBlockMask) != block) {
      block = key & ~kInBlockMask;
      words = marks.block(marks.touch(key)).free.data();
    }
    words[wordOf(key)] |= std::uint64_t{1} << bitOf(key);
    key += axis.step;
    border += axis.border_spacing;
    limit = length;
    return key != end_key;
  };
  for (bool is_going = true; is_going;) {
    if (next_x < next_y)
      is_going = next_x < next_z ? leave(next_x, x) : leave(next_z, z);
    else
      is_going = next_y < next_z ? leave(next_y, y) : leave(next_z, z);
  }
}

}  // namespace

ScanTracer::ScanTracer(const Eigen::Vector3f& origin, double resolution_m, double range_max_m)
    : origin_(origin),
      resolution_m_(resolution_m),
      inverse_resolution_(1.0 / resolution_m),
      range_max_m_(range_max_m),
      origin_key_(keyOf(origin)) {}

PackedKey ScanTracer::keyOf(const Eigen::Vector3f& point) const {
  return packIndex(voxelOf(point.cast<double>(), inverse_resolution_));
}

Eigen::Vector3f ScanTracer::centreAround(const Eigen::Vector3f& point) const {
  const VoxelIndex index = voxelOf(point.cast<double>(), inverse_resolution_);
  return ((index.cast<double>().array() + 0.5) * resolution_m_).cast<float>();
}

void ScanTracer::trace(const Eigen::Vector3f& end, ScanMarks& marks) const {
  const octomap::point3d from = toOctomap(origin_);
  const octomap::point3d difference = toOctomap(end) - from;
  if (difference.norm() <= range_max_m_) {
    markFree(end, marks);
    marks.markHit(keyOf(end));
    return;
  }
  const octomap::point3d cut = from + difference.normalized() * static_cast<float>(range_max_m_);
  markFree({cut.x(), cut.y(), cut.z()}, marks);
}

void ScanTracer::markFree(const Eigen::Vector3f& end, ScanMarks& marks) const {
  const PackedKey end_key = keyOf(end);
  if (end_key == origin_key_) return;
  octomap::point3d direction = toOctomap(end) - toOctomap(origin_);
  const auto length = static_cast<float>(direction.norm());
  direction /= length;
  const VoxelIndex start = unpackIndex(origin_key_);
  const auto walk = [&](int axis) {
    return walkOf(axis, direction(static_cast<unsigned>(axis)), origin_(axis), resolution_m_,
                  start(axis) + kKeyOffset);
  };
  markWalk(walk(0), walk(1), walk(2), origin_key_, end_key, length, marks);
}

}  // namespace spelunk::map
