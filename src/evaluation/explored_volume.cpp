#include "spelunk/evaluation/explored_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spelunk::evaluation {
namespace {

constexpr double kCountedPeriod_s = 0.2;  // of the scans of one sensor

/// One axis of a voxel walk (Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing,
/// Eurographics 1987); lengths in voxels.
struct Axis {
  double next = std::numeric_limits<double>::infinity();  ///< Length at which it steps next.
  double spacing = std::numeric_limits<double>::infinity();
  double exit = std::numeric_limits<double>::infinity();  ///< Length at which the grid ends.
  std::ptrdiff_t stride = 0;                              ///< Change of the grid's offset.
};

Axis axisOf(double from, double direction, int size, std::ptrdiff_t stride) {
  Axis axis;
  if (direction == 0.0) return axis;
  const bool is_up = direction > 0.0;
  const double cell = std::floor(from);
  axis.spacing = std::abs(1.0 / direction);
  axis.next = (is_up ? cell + 1.0 - from : from - cell) * axis.spacing;
  axis.exit = (is_up ? size - from : from) * axis.spacing;
  axis.stride = is_up ? stride : -stride;
  return axis;
}

}  // namespace

ExploredVolume::ExploredVolume(const AxisAlignedBox& bounds, double resolution_m, RayChoice choice)
    : seen_(bounds, resolution_m), endings_(bounds, resolution_m), choice_(choice) {}

double ExploredVolume::volume_m3() const {
  const double edge = seen_.resolution();
  return static_cast<double>(voxels_) * edge * edge * edge;
}

bool ExploredVolume::takes(const Scan& scan) {
  return thinnings_.try_emplace(scan.sensor, kCountedPeriod_s).first->second.takes(scan.stamp_s);
}

bool ExploredVolume::isFirstToEndIn(const Eigen::Vector3d& end) {
  const Eigen::Vector3i cell = endings_.cellOf(end);
  if (!endings_.contains(cell)) return true;
  const std::size_t offset = endings_.offsetOf(cell);
  if (!endings_.set(offset)) return false;
  marked_endings_.push_back(offset);
  return true;
}

void ExploredVolume::walk(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                          double length) {
  const Eigen::Vector3i& size = seen_.size();
  const std::ptrdiff_t row = size.x();
  const Axis x = axisOf(from.x(), direction.x(), size.x(), 1);
  const Axis y = axisOf(from.y(), direction.y(), size.y(), row);
  const Axis z = axisOf(from.z(), direction.z(), size.z(), row * size.y());
  constexpr double kInside = 1e-6;  // voxels: rounding must not lead out of the grid
  const double limit = std::min({length, x.exit - kInside, y.exit - kInside, z.exit - kInside});
  double next_x = x.next;
  double next_y = y.next;
  double next_z = z.next;
  auto offset = static_cast<std::ptrdiff_t>(seen_.offsetOf(from.array().floor().cast<int>()));
  std::size_t found = 0;
  const auto leave = [&](double& next, const Axis& axis) {
    found += seen_.set(static_cast<std::size_t>(offset)) ? 1 : 0;
    if (next > limit) return false;
    offset += axis.stride;
    next += axis.spacing;
    return true;
  };
  for (bool is_going = true; is_going;) {
    if (next_x < next_y)
      is_going = next_x < next_z ? leave(next_x, x) : leave(next_z, z);
    else
      is_going = next_y < next_z ? leave(next_y, y) : leave(next_z, z);
  }
  voxels_ += found;
}

void ExploredVolume::add(const sim::SimulatedScan& scan) {
  if (choice_ == RayChoice::kOneAnEnding && !takes(scan.scan)) return;
  const Eigen::Matrix3d rotation = scan.T_world_sensor_true.linear();
  const Eigen::Vector3d origin = scan.T_world_sensor_true.translation();
  const Eigen::Vector3d from = seen_.scaled(origin);
  if (!seen_.contains(seen_.cellOf(origin))) return;
  for (std::size_t i = 0; i < scan.true_ranges.size(); ++i) {
    const Eigen::Vector3d direction = rotation * (*scan.directions)[i].cast<double>();
    const double range = scan.true_ranges[i];
    if (choice_ == RayChoice::kAll || isFirstToEndIn(origin + range * direction))
      walk(from, direction, range / seen_.resolution());
  }
  for (const std::size_t offset : marked_endings_) endings_.clear(offset);
  marked_endings_.clear();
}

}  // namespace spelunk::evaluation
