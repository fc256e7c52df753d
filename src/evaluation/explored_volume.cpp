#include "spelunk/evaluation/explored_volume.h"

#include <cmath>
#include <limits>

namespace spelunk::evaluation {
namespace {

/// One axis of a voxel walk (Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray Tracing,
/// Eurographics 1987); lengths in voxels.
struct Axis {
  double next = std::numeric_limits<double>::infinity();  ///< Length at which it steps next.
  double step_length = std::numeric_limits<double>::infinity();
  std::ptrdiff_t stride = 0;  ///< Change of the grid's offset.
  int steps_left = 0;         ///< Until the grid ends.
};

Axis axisOf(double from, double direction, int cell, int size, std::ptrdiff_t stride) {
  Axis axis;
  if (direction == 0.0) return axis;
  const bool is_up = direction > 0.0;
  axis.step_length = std::abs(1.0 / direction);
  axis.next = (is_up ? cell + 1 - from : from - cell) * axis.step_length;
  axis.stride = is_up ? stride : -stride;
  axis.steps_left = is_up ? size - 1 - cell : cell;
  return axis;
}

}  // namespace

ExploredVolume::ExploredVolume(const AxisAlignedBox& bounds, double resolution_m, RayChoice choice)
    : seen_(bounds, resolution_m), endings_(bounds, resolution_m), choice_(choice) {}

double ExploredVolume::volume_m3() const {
  const double edge = seen_.resolution();
  return static_cast<double>(voxels_) * edge * edge * edge;
}

bool ExploredVolume::isFirstToEndIn(const Eigen::Vector3d& end) {
  const Eigen::Vector3i cell = endings_.cellOf(end);
  if (!endings_.contains(cell)) return true;
  const std::size_t offset = endings_.offsetOf(cell);
  if (!endings_.set(offset)) return false;
  marked_endings_.push_back(offset);
  return true;
}

void ExploredVolume::walk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                          double range_m) {
  const Eigen::Vector3i cell = seen_.cellOf(origin);
  if (!seen_.contains(cell)) return;
  const Eigen::Vector3d from = seen_.scaled(origin);
  const double length = range_m / seen_.resolution();
  const Eigen::Vector3i& size = seen_.size();
  const std::ptrdiff_t strides[3] = {1, size.x(), static_cast<std::ptrdiff_t>(size.x()) * size.y()};
  Axis axes[3];
  for (int i = 0; i < 3; ++i) axes[i] = axisOf(from[i], direction[i], cell[i], size[i], strides[i]);
  auto offset = static_cast<std::ptrdiff_t>(seen_.offsetOf(cell));
  for (;;) {
    voxels_ += seen_.set(static_cast<std::size_t>(offset)) ? 1 : 0;
    Axis& axis = axes[0].next < axes[1].next ? (axes[0].next < axes[2].next ? axes[0] : axes[2])
                                             : (axes[1].next < axes[2].next ? axes[1] : axes[2]);
    if (axis.next > length || axis.steps_left-- == 0) return;
    offset += axis.stride;
    axis.next += axis.step_length;
  }
}

void ExploredVolume::add(const sim::SimulatedScan& scan) {
  if (choice_ == RayChoice::kOneAnEnding && scans_++ % 2 == 1) return;
  const Eigen::Matrix3d rotation = scan.T_world_sensor_true.linear();
  const Eigen::Vector3d origin = scan.T_world_sensor_true.translation();
  for (std::size_t i = 0; i < scan.true_ranges.size(); ++i) {
    const Eigen::Vector3d direction = rotation * (*scan.directions)[i].cast<double>();
    const double range = scan.true_ranges[i];
    if (choice_ == RayChoice::kAll || isFirstToEndIn(origin + range * direction))
      walk(origin, direction, range);
  }
  for (const std::size_t offset : marked_endings_) endings_.clear(offset);
  marked_endings_.clear();
}

}  // namespace spelunk::evaluation
