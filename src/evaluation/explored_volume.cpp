#include "spelunk/evaluation/explored_volume.h"

#include <algorithm>
#include <cmath>

#include "ray_block.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/wide_loops.h"

namespace spelunk::evaluation {
namespace {

constexpr double kCountedPeriod_s = 0.2;  // of the scans of one sensor
constexpr double kOutside = -1.0;

/// What it takes to find the voxels in which the rays of a scan end.
struct EndFrame {
  Eigen::Vector3d origin;  ///< Of the rays.
  Eigen::Vector3d corner;  ///< Of the grid.
  Eigen::Vector3d size;    ///< Of the grid, voxels.
  double resolution_m;
};

/// The offsets of those voxels (whole numbers; doubles suit wide loops), or kOutside.
struct Ends {
  alignas(64) double of[RayBlock::kRays];
};

SPELUNK_WIDE_IF_POSSIBLE void turn(const Eigen::Vector3f* directions, const Eigen::Matrix3d& R,
                                   RayBlock& rays) {
  const double r00 = R(0, 0), r01 = R(0, 1), r02 = R(0, 2);
  const double r10 = R(1, 0), r11 = R(1, 1), r12 = R(1, 2);
  const double r20 = R(2, 0), r21 = R(2, 1), r22 = R(2, 2);
  const float* from = directions->data();
  for (std::size_t i = 0; i < rays.count; ++i) {
    const double x = from[3 * i], y = from[3 * i + 1], z = from[3 * i + 2];
    rays.x[i] = r00 * x + r01 * y + r02 * z;
    rays.y[i] = r10 * x + r11 * y + r12 * z;
    rays.z[i] = r20 * x + (r21 * y + r22 * z);  // the order in which Eigen adds
  }
}

SPELUNK_WIDE_IF_POSSIBLE void findEnds(const float* ranges, const EndFrame& frame, RayBlock& rays,
                                       Ends& ends) {
  const double resolution = frame.resolution_m;
  const double scale = 1.0 / resolution;
  const double origin_x = frame.origin.x(), origin_y = frame.origin.y();
  const double origin_z = frame.origin.z();
  const double corner_x = frame.corner.x(), corner_y = frame.corner.y();
  const double corner_z = frame.corner.z();
  const double size_x = frame.size.x(), size_y = frame.size.y(), size_z = frame.size.z();
  for (std::size_t i = 0; i < rays.count; ++i) {
    const double range = ranges[i];
    rays.length[i] = range / resolution;
    const double x = std::floor((origin_x + range * rays.x[i] - corner_x) * scale);
    const double y = std::floor((origin_y + range * rays.y[i] - corner_y) * scale);
    const double z = std::floor((origin_z + range * rays.z[i] - corner_z) * scale);
    const double lowest = std::min(x, std::min(y, z));
    const double beyond = std::max(x - size_x, std::max(y - size_y, z - size_z));
    const double offset = x + size_x * (y + size_y * z);
    ends.of[i] = lowest >= 0.0 && beyond < 0.0 ? offset : kOutside;
  }
}

}  // namespace

ExploredVolume::ExploredVolume(const AxisAlignedBox& bounds, double resolution_m, RayChoice choice)
    : seen_(bounds, resolution_m), endings_(bounds, resolution_m), choice_(choice) {}

double ExploredVolume::volume_m3() const { return volumeOf(voxels_); }

double ExploredVolume::volumeOf(std::size_t voxels) const {
  const double edge = seen_.resolution();
  return static_cast<double>(voxels) * edge * edge * edge;
}

SeenVolume ExploredVolume::partedBy(const ReachableSpace& space) const {
  require(space.free.size() == seen_.size() && space.free.corner() == seen_.corner(),
          "ExploredVolume: the space has other bounds or another resolution");
  std::size_t inside = 0;
  if (space.is_enclosed) {
    inside = std::min(voxels_, space.free_voxels + space.surface_voxels);
  } else {
    for (std::size_t word = 0; word < seen_.wordCount(); ++word)
      inside += static_cast<std::size_t>(__builtin_popcountll(
          seen_.words()[word] & (space.free.words()[word] | space.surface.words()[word])));
  }
  return {volumeOf(inside), volumeOf(voxels_ - inside)};
}

bool ExploredVolume::takes(const Scan& scan) {
  return thinnings_.try_emplace(scan.sensor, kCountedPeriod_s).first->second.takes(scan.stamp_s);
}

/// Without branches but the first: nothing foretells which rays share an ending.
void ExploredVolume::keepFirstOnes(const double* ends, RayBlock& rays) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rays.count; ++i) {
    rays.x[kept] = rays.x[i];
    rays.y[kept] = rays.y[i];
    rays.z[kept] = rays.z[i];
    rays.length[kept] = rays.length[i];
    if (ends[i] == kOutside) {
      ++kept;
      continue;
    }
    const auto voxel = static_cast<std::size_t>(ends[i]);
    const std::size_t is_first = endings_.set(voxel) ? 1 : 0;
    marked_endings_[endings_count_] = voxel;
    endings_count_ += is_first;
    kept += is_first;
  }
  rays.count = kept;
}

void ExploredVolume::add(const sim::SimulatedScan& scan) {
  if (choice_ == RayChoice::kOneAnEnding && !takes(scan.scan)) return;
  const Eigen::Matrix3d rotation = scan.T_world_sensor_true.linear();
  const Eigen::Vector3d origin = scan.T_world_sensor_true.translation();
  if (!seen_.contains(seen_.cellOf(origin))) return;
  const EndFrame frame{origin, seen_.corner(), seen_.size().cast<double>(), seen_.resolution()};
  RayBlock rays;
  rays.from = seen_.scaled(origin);
  Ends ends;
  marked_endings_.resize(scan.true_ranges.size());
  for (std::size_t first = 0; first < scan.true_ranges.size(); first += RayBlock::kRays) {
    rays.count = std::min(RayBlock::kRays, scan.true_ranges.size() - first);
    turn(&(*scan.directions)[first], rotation, rays);
    findEnds(&scan.true_ranges[first], frame, rays, ends);
    if (choice_ == RayChoice::kOneAnEnding) keepFirstOnes(ends.of, rays);
    voxels_ += mark(rays, seen_);
  }
  for (std::size_t i = 0; i < endings_count_; ++i) endings_.clear(marked_endings_[i]);
  endings_count_ = 0;
}

}  // namespace spelunk::evaluation
