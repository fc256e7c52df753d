#include "silence_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spelunk::map {
namespace {

constexpr double kShareOfReach = 0.25;

double rangeOf(const SensorModel& sensor, double gap_m) {
  return std::min(denseRange(sensor, gap_m), kShareOfReach * sensor.range_max_m);
}

/// Steps along a ray from voxel to voxel.
class VoxelWalk {
 public:
  VoxelWalk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double resolution_m)
      : index_(voxelOf(origin, 1.0 / resolution_m)) {
    for (int axis = 0; axis < 3; ++axis) {
      const double d = direction(axis);
      step_(axis) = d < 0.0 ? -1 : 1;
      const double border = resolution_m * (index_(axis) + (d < 0.0 ? 0 : 1));
      constexpr double kNever = std::numeric_limits<double>::infinity();
      spacing_(axis) = d == 0.0 ? kNever : resolution_m / std::fabs(d);
      next_(axis) = d == 0.0 ? kNever : (border - origin(axis)) / d;
    }
  }
  [[nodiscard]] const VoxelIndex& index() const { return index_; }
  /// Enters the next voxel; returns the length there, metres.
  double advance() {
    int axis = next_(0) <= next_(1) ? 0 : 1;
    if (next_(2) < next_(axis)) axis = 2;
    const double length = next_(axis);
    next_(axis) += spacing_(axis);
    index_(axis) += step_(axis);
    return length;
  }

 private:
  VoxelIndex index_;
  VoxelIndex step_;
  Eigen::Vector3d next_;
  Eigen::Vector3d spacing_;
};

}  // namespace

DirectionCells::DirectionCells(double angle)
    : side_(static_cast<int>(std::clamp(std::ceil(2.0 / angle), 1.0, 1000.0))) {}

SilenceWatch::SilenceWatch(const SensorModel& sensor, double gap_m, double resolution_m)
    : range_m_(rangeOf(sensor, gap_m)),
      resolution_m_(resolution_m),
      cells_(resolution_m / range_m_),
      has_return_(cells_.count(), 0) {
  std::vector<char> has_ray(cells_.count(), 0);
  for (const Eigen::Vector3f& direction : rayDirections(sensor)) {
    const auto cell = cells_.cellOf(direction);
    if (!cell || has_ray[*cell] != 0) continue;
    has_ray[*cell] = 1;
    rays_.push_back({direction.cast<double>(), *cell});
  }
}

bool SilenceWatch::takes(const Scan& scan) {
  const Eigen::Vector3d place = scan.T_world_sensor.translation();
  if (last_place_ && (place - *last_place_).norm() < spacing()) return false;
  last_place_ = place;
  return true;
}

void SilenceWatch::noteReturns(const Scan& scan) {
  std::fill(has_return_.begin(), has_return_.end(), 0);
  for (const Eigen::Vector3f& point : scan.points)
    if (const auto cell = cells_.cellOf(point)) has_return_[*cell] = 1;
}

void SilenceWatch::follow(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                          const BlockMap& map, std::vector<PackedKey>& looked_into) const {
  VoxelWalk walk(origin, direction, resolution_m_);
  bool was_free = false;
  int unknown = 0;
  for (double length = 0.0; length < range_m_ && unknown < kDepth; length = walk.advance()) {
    if (!isInKeyRange(walk.index())) return;
    const Occupancy status = map.at(walk.index());
    if (status == Occupancy::kOccupied) return;
    if (status == Occupancy::kFree) {
      was_free = true;
      unknown = 0;
    } else if (was_free) {
      ++unknown;
      looked_into.push_back(packIndex(walk.index()));
    }
  }
}

std::vector<PackedKey> SilenceWatch::voxelsLookedInto(const Scan& scan, const BlockMap& map) {
  noteReturns(scan);
  const Eigen::Vector3d origin = scan.T_world_sensor.translation();
  std::vector<PackedKey> looked_into;
  for (const Ray& ray : rays_)
    if (has_return_[ray.cell] == 0)
      follow(origin, scan.T_world_sensor.linear() * ray.direction, map, looked_into);
  return looked_into;
}

}  // namespace spelunk::map
