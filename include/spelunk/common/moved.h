#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/common/pose.h"
#include "spelunk/common/trajectory.h"

namespace spelunk {

/// From one upright frame to another: a turn about +z, then a translation. p' = R(yaw) * p + by.
struct Shift {
  Eigen::Vector3d by = Eigen::Vector3d::Zero();  ///< Metres.
  double yaw_rad = 0.0;
  /// Boxes stay parallel to the axes: they are moved as this place is, before the shift. What of a
  /// box lies far from it is off by its distance times the turn.
  Eigen::Vector3d about = Eigen::Vector3d::Zero();

  Shift() = default;
  template <class Derived>
  Shift(const Eigen::MatrixBase<Derived>& translation)
      : by(translation) {}  // NOLINT: a parallel frame
  Shift(const Eigen::Vector3d& translation, double yaw) : by(translation), yaw_rad(yaw) {}

  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& point) const {
    return turned(point) + by;
  }
  /// Of a direction or a velocity.
  [[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& direction) const;
  [[nodiscard]] Shift inverse() const;
  [[nodiscard]] Shift after(const Shift& first) const;  ///< `first`, then this one.
};

/// The shift that takes `from` to `to`.
[[nodiscard]] Shift shiftBetween(const Pose& from, const Pose& to);

/// The same thing in another frame: everything in it that is a place or a direction is shifted.
/// Infinite sides of boxes and prisms stay infinite.
[[nodiscard]] Eigen::Vector3d moved(Eigen::Vector3d point, const Shift& shift);
[[nodiscard]] Eigen::Isometry3d moved(Eigen::Isometry3d T, const Shift& shift);
[[nodiscard]] Pose moved(Pose pose, const Shift& shift);
[[nodiscard]] RobotState moved(RobotState state, const Shift& shift);
[[nodiscard]] TrajectoryPoint moved(TrajectoryPoint point, const Shift& shift);
[[nodiscard]] AxisAlignedBox moved(AxisAlignedBox box, const Shift& shift);
[[nodiscard]] NoGoZone moved(NoGoZone zone, const Shift& shift);

/// A sentence for people. The places that it names are written as "(x, y, z)", in metres; they keep
/// the number of their decimals.
[[nodiscard]] std::string moved(const std::string& sentence, const Shift& shift);

/// Each item of a list (Path, Trajectory, zones, ...).
template <class T>
[[nodiscard]] std::vector<T> moved(std::vector<T> list, const Shift& shift) {
  for (T& item : list) item = moved(std::move(item), shift);
  return list;
}

}  // namespace spelunk
