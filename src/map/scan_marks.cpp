#include "scan_marks.h"

#include <octomap/octomap_types.h>

#include <algorithm>
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

/// Sets free bits along a walk; looks a block up only when the walk enters it.
class FreeMarker {
 public:
  FreeMarker(ScanMarks& marks, PackedKey first) : marks_(marks) { enter(first); }

  void mark(PackedKey voxel) {
    if ((voxel & ~kInBlockMask) != block_) enter(voxel);
    words_[wordOf(voxel)] |= std::uint64_t{1} << bitOf(voxel);
  }

 private:
  void enter(PackedKey voxel) {
    block_ = voxel & ~kInBlockMask;
    words_ = marks_.block(marks_.touch(voxel)).free.data();
  }

  ScanMarks& marks_;
  PackedKey block_ = 0;
  std::uint64_t* words_ = nullptr;
};

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
  AxisWalk x = walk(0);
  AxisWalk y = walk(1);
  AxisWalk z = walk(2);
  FreeMarker marker(marks, origin_key_);
  marker.mark(origin_key_);
  PackedKey key = origin_key_;
  const auto advance = [&key](AxisWalk& axis) {
    key += axis.step;
    axis.next_border += axis.border_spacing;
  };
  for (;;) {
    if (x.next_border < y.next_border) {
      if (x.next_border < z.next_border)
        advance(x);
      else
        advance(z);
    } else if (y.next_border < z.next_border) {
      advance(y);
    } else {
      advance(z);
    }
    if (key == end_key) return;
    // Rounding can lead the walk past the end's voxel: OctoMap stops at the ray's length.
    if (std::min(std::min(x.next_border, y.next_border), z.next_border) > length) return;
    marker.mark(key);
  }
}

}  // namespace spelunk::map
