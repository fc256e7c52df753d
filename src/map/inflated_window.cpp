#include "spelunk/map/inflated_window.h"

#include <array>
#include <cmath>
#include <limits>

#include "bit_grid.h"
#include "spelunk/common/contract.h"
#include "voxel_key.h"

namespace spelunk::map {
namespace {

// A face that lies exactly on a border between voxels must not count as touching the next one.
constexpr double kFaceTolerance = 1e-4;  // metres

/// The voxels a box touches, in window coordinates.
struct VoxelBox {
  VoxelIndex first;
  VoxelIndex last;
};

/// One axis of a moving box: when its leading face enters the next voxel and when its trailing
/// face leaves one. Times are shares of the way.
struct AxisMotion {
  int step = 0;
  double lead_time = std::numeric_limits<double>::infinity();
  double trail_time = std::numeric_limits<double>::infinity();
  double period = std::numeric_limits<double>::infinity();

  AxisMotion() = default;
  /// Faces and way in voxels.
  AxisMotion(double low_face, double high_face, double way) {
    if (way == 0.0) return;
    step = way > 0.0 ? 1 : -1;
    period = 1.0 / std::fabs(way);
    const auto timeTo = [&](double face) {
      const double below = voxelOf(face, 1.0);
      return (way > 0.0 ? below + 1.0 - face : face - below) * period;
    };
    lead_time = timeTo(way > 0.0 ? high_face : low_face);
    trail_time = timeTo(way > 0.0 ? low_face : high_face);
  }
};

}  // namespace

struct InflatedWindow::Impl {
  Impl(const LocalWindow& window, const Eigen::Vector3d& box_size, Passable passable);

  [[nodiscard]] VoxelBox boxOf(const Eigen::Vector3d& centre) const {
    return {voxelOf(centre - half, inverse_resolution) - origin,
            voxelOf(centre + half, inverse_resolution) - origin};
  }
  [[nodiscard]] bool isFree(const VoxelBox& box) const {
    const VoxelIndex extra = box.last - box.first - min_span;
    if ((extra.array() >= 0).all() && (extra.array() <= 1).all())
      return inflated[static_cast<std::size_t>(extra.x() + 2 * extra.y() + 4 * extra.z())].at(
          box.first);
    return free.areAllSet(box.first, box.last);  // a box of whole voxels, and rounding
  }
  [[nodiscard]] Occupancy reasonAt(const VoxelBox& box) const {
    return occupied.isAnySet(box.first, box.last) ? Occupancy::kOccupied : Occupancy::kUnknown;
  }
  template <class Blocked>
  bool walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Blocked&& blocked) const;

  Eigen::Vector3d box_size;
  Eigen::Vector3d half;
  double inverse_resolution;
  VoxelIndex origin;
  VoxelIndex min_span;  ///< Last minus first voxel of the box at its best phase; else one more.
  BitGrid free;
  BitGrid occupied;
  std::array<BitGrid, 8> inflated;  ///< By phase: one bit an axis, set if the box spans one more.
};

InflatedWindow::Impl::Impl(const LocalWindow& window, const Eigen::Vector3d& size,
                           Passable passable)
    : box_size(size),
      half(0.5 * size.array() - kFaceTolerance),
      inverse_resolution(1.0 / window.resolution()),
      origin(window.origin()),
      min_span((2.0 * half * inverse_resolution).cast<int>()),
      free(passable == Passable::kKnownFree ? BitGrid(window, Occupancy::kFree)
                                            : BitGrid::notOccupied(window)),
      occupied(window, Occupancy::kOccupied) {
  inflated[0] = free;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t phases = std::size_t{1} << axis;
    for (std::size_t i = 0; i < phases; ++i) {
      inflated[i].erode(axis, min_span(axis) + 1);
      inflated[i + phases] = inflated[i];
      inflated[i + phases].andShifted(axis, 1);
    }
  }
}

/// Looks at the box at `a`, whenever it enters a new layer of voxels on an axis, and at `b`: in
/// between the box only leaves voxels, so these boxes cover everything the sweep touches. A voxel
/// left in the very moment another is entered still counts.
template <class Blocked>
bool InflatedWindow::Impl::walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                Blocked&& blocked) const {
  VoxelBox box = boxOf(a);
  if (!isFree(box)) return blocked(box);
  std::array<AxisMotion, 3> motion;
  for (int i = 0; i < 3; ++i)
    motion[static_cast<std::size_t>(i)] = {(a(i) - half(i)) * inverse_resolution,
                                           (a(i) + half(i)) * inverse_resolution,
                                           (b(i) - a(i)) * inverse_resolution};
  for (;;) {
    int axis = motion[0].lead_time <= motion[1].lead_time ? 0 : 1;
    if (motion[2].lead_time < motion[static_cast<std::size_t>(axis)].lead_time) axis = 2;
    AxisMotion& leading = motion[static_cast<std::size_t>(axis)];
    const double time = leading.lead_time;
    if (!(time <= 1.0)) break;
    for (int i = 0; i < 3; ++i) {
      AxisMotion& trailing = motion[static_cast<std::size_t>(i)];
      for (; trailing.trail_time < time; trailing.trail_time += trailing.period)
        (trailing.step > 0 ? box.first : box.last)(i) += trailing.step;
    }
    (leading.step > 0 ? box.last : box.first)(axis) += leading.step;
    leading.lead_time += leading.period;
    if (!isFree(box)) return blocked(box);
  }
  const VoxelBox end = boxOf(b);
  return isFree(end) || blocked(end);
}

InflatedWindow::InflatedWindow(const LocalWindow& window, const Eigen::Vector3d& box_size,
                               Passable passable) {
  require(box_size.allFinite() && (box_size.array() > 2.0 * kFaceTolerance).all(),
          "InflatedWindow: the box must have a positive size");
  require((box_size.array() < 1e6 * window.resolution()).all(), "InflatedWindow: box too large");
  impl_ = std::make_unique<Impl>(window, box_size, passable);
}
InflatedWindow::~InflatedWindow() = default;
InflatedWindow::InflatedWindow(InflatedWindow&&) noexcept = default;

bool InflatedWindow::isFree(const Eigen::Vector3d& centre) const {
  return impl_->isFree(impl_->boxOf(centre));
}

Occupancy InflatedWindow::boxAt(const Eigen::Vector3d& centre) const {
  const VoxelBox box = impl_->boxOf(centre);
  return impl_->isFree(box) ? Occupancy::kFree : impl_->reasonAt(box);
}

bool InflatedWindow::isSweepFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  return impl_->walk(a, b, [](const VoxelBox&) { return false; });
}

Occupancy InflatedWindow::sweep(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  Occupancy answer = Occupancy::kFree;
  impl_->walk(a, b, [&](const VoxelBox& box) {
    answer = impl_->reasonAt(box);
    return false;
  });
  return answer;
}

const Eigen::Vector3d& InflatedWindow::boxSize() const { return impl_->box_size; }

}  // namespace spelunk::map
