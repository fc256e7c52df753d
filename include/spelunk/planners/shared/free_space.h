#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/map/occupancy.h"

namespace spelunk::planners {

/// Why the robot's box may not be at a place.
enum class Rejection { kNone, kOccupied, kUnknown, kOutOfBounds, kNoGo };

/// Where the robot's box may go: known free space inside the bounds and outside all zones. A view
/// for the duration of one plan: what it refers to must outlive it.
class FreeSpace {
 public:
  /// Status of the box moved straight between two points.
  using Sweep = std::function<map::Occupancy(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

  FreeSpace(Sweep sweep, const Eigen::Vector3d& box_size, const AxisAlignedBox& bounds,
            const std::vector<NoGoZone>& zones);

  [[nodiscard]] Rejection at(const Eigen::Vector3d& point) const { return along(point, point); }
  [[nodiscard]] Rejection along(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] bool isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return along(a, b) == Rejection::kNone;
  }

 private:
  Sweep sweep_;
  Eigen::Vector3d box_size_;
  const AxisAlignedBox& bounds_;
  const std::vector<NoGoZone>& zones_;
};

}  // namespace spelunk::planners
