#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/common/pose.h"
#include "spelunk/common/trajectory.h"

namespace spelunk {

/// The same thing in a parallel frame: everything in it that is a place is moved by `by`, metres.
/// Infinite sides of boxes and prisms stay infinite.
[[nodiscard]] Eigen::Vector3d moved(Eigen::Vector3d point, const Eigen::Vector3d& by);
[[nodiscard]] Eigen::Isometry3d moved(Eigen::Isometry3d T, const Eigen::Vector3d& by);
[[nodiscard]] Pose moved(Pose pose, const Eigen::Vector3d& by);
[[nodiscard]] RobotState moved(RobotState state, const Eigen::Vector3d& by);
[[nodiscard]] TrajectoryPoint moved(TrajectoryPoint point, const Eigen::Vector3d& by);
[[nodiscard]] AxisAlignedBox moved(AxisAlignedBox box, const Eigen::Vector3d& by);
[[nodiscard]] NoGoZone moved(NoGoZone zone, const Eigen::Vector3d& by);

/// A sentence for people. The places that it names are written as "(x, y, z)", in metres; they keep
/// the number of their decimals.
[[nodiscard]] std::string moved(const std::string& sentence, const Eigen::Vector3d& by);

/// Each item of a list (Path, Trajectory, zones, ...).
template <class T>
[[nodiscard]] std::vector<T> moved(std::vector<T> list, const Eigen::Vector3d& by) {
  for (T& item : list) item = moved(std::move(item), by);
  return list;
}

}  // namespace spelunk
