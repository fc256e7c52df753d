#include "scan_tracer.h"

#include <octomap/octomap_types.h>

#include <cmath>
#include <limits>

#include "spelunk/common/wide_loops.h"

namespace spelunk::map {
namespace {

octomap::point3d toOctomap(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

/// Lengths of the rays to `ends`, rounded as octomath rounds them.
SPELUNK_WIDE_IF_POSSIBLE void findNorms(const float* x, const float* y, const float* z,
                                        std::size_t count, const Eigen::Vector3f& origin,
                                        double* __restrict norms) {
  const float origin_x = origin.x(), origin_y = origin.y(), origin_z = origin.z();
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = x[i] - origin_x, dy = y[i] - origin_y, dz = z[i] - origin_z;
    norms[i] = std::sqrt(static_cast<double>(dx * dx + dy * dy + dz * dz));
  }
}

void findNorms(const ScanEnds& ends, const Eigen::Vector3f& origin, std::vector<double>& norms) {
  if (norms.size() < ends.count) norms.resize(ends.count);
  findNorms(ends.point[0].data(), ends.point[1].data(), ends.point[2].data(), ends.count, origin,
            norms.data());
}

/// One axis of all walks. The arithmetic (float directions, double sums, voxel border rounded
/// through float) is that of OcTree::computeRayKeys.
struct AxisOfWalks {
  double origin;
  double border_above;  ///< Of the origin's voxel.
  double border_below;
  double resolution;

  AxisOfWalks(float from, int voxel, double resolution_m) : origin(from), resolution(resolution_m) {
    const double centre = (voxel + 0.5) * resolution_m;
    border_above = centre + static_cast<float>(resolution_m * 0.5);
    border_below = centre + static_cast<float>(-resolution_m * 0.5);
  }
};

SPELUNK_WIDE_IF_POSSIBLE void setAxis(const AxisOfWalks& axis, const float* ends,
                                      const double* norms, std::size_t count,
                                      double* __restrict next, double* __restrict spacing,
                                      std::int32_t* __restrict step) {
  constexpr double kNever = std::numeric_limits<double>::max();
  const auto from = static_cast<float>(axis.origin);
  const double above = axis.border_above - axis.origin;
  const double below = axis.border_below - axis.origin;
  const double resolution = axis.resolution;
  for (std::size_t i = 0; i < count; ++i) {
    const float direction = (ends[i] - from) / static_cast<float>(norms[i]);
    const auto wide = static_cast<double>(direction);
    const double first = (direction > 0.0F ? above : below) / wide;
    const double between = resolution / std::fabs(wide);
    next[i] = direction == 0.0F ? kNever : first;
    spacing[i] = direction == 0.0F ? kNever : between;
    step[i] =
        static_cast<std::int32_t>(direction > 0.0F) - static_cast<std::int32_t>(direction < 0.0F);
  }
}

/// As octomath rounds them once more when a ray is normalized.
SPELUNK_WIDE_IF_POSSIBLE void roundLengths(const double* norms, std::size_t count,
                                           double* __restrict lengths) {
  for (std::size_t i = 0; i < count; ++i) lengths[i] = static_cast<float>(norms[i]);
}

/// Rays that end in the voxel they start from walk nowhere.
void removeEndsIn(const VoxelIndex& voxel, ScanEnds& ends) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ends.count; ++i)
    if (ends.voxelAt(i) != voxel) ends.set(kept++, ends.pointAt(i), ends.voxelAt(i));
  ends.count = kept;
}

}  // namespace

ScanTracer::ScanTracer(const MapParams& params)
    : resolution_m_(params.resolution_m), range_max_m_(params.range_max_m) {}

void ScanTracer::cutAtRange(const Eigen::Vector3f& origin, ScanEnds& ends, ScanMarks& marks) {
  findNorms(ends, origin, norms_);
  bool is_any_cut = false;
  for (std::size_t i = 0; i < ends.count; ++i)
    if (isTooFar(i)) {
      is_any_cut = true;
      marks.unmarkHit(packIndex(ends.voxelAt(i)));
    }
  if (!is_any_cut) return;
  for (std::size_t i = 0; i < ends.count; ++i) {
    if (!isTooFar(i)) {
      marks.markHit(packIndex(ends.voxelAt(i)));  // it may share the voxel of one that is
      continue;
    }
    const octomap::point3d from = toOctomap(origin);
    const octomap::point3d ray = toOctomap(ends.pointAt(i)) - from;
    const octomap::point3d cut = from + ray.normalized() * static_cast<float>(range_max_m_);
    const Eigen::Vector3f end(cut.x(), cut.y(), cut.z());
    ends.set(i, end, voxelOf(end.cast<double>(), 1.0 / resolution_m_));
  }
}

void ScanTracer::layOut(const Eigen::Vector3f& origin, ScanEnds& ends, ScanMarks& marks,
                        RayWalks& walks) {
  cutAtRange(origin, ends, marks);
  walks.start = voxelOf(origin.cast<double>(), 1.0 / resolution_m_);
  removeEndsIn(walks.start, ends);
  findNorms(ends, origin, norms_);
  walks.resize(ends.count);
  for (int i = 0; i < 3; ++i) {
    const AxisOfWalks axis(origin(i), walks.start(i), resolution_m_);
    setAxis(axis, ends.point[i].data(), norms_.data(), ends.count, walks.next[i].data(),
            walks.spacing[i].data(), walks.step[i].data());
    std::copy_n(ends.voxel[i].data(), ends.count, walks.end[i].data());
  }
  roundLengths(norms_.data(), ends.count, walks.length.data());
}

}  // namespace spelunk::map
