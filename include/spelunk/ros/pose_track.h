#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>

#include "spelunk/common/moved.h"

namespace spelunk::bridge {

/// Where the robot's base was of late, by odometry. Times are ROS time in seconds; not thread-safe.
class PoseTrack {
 public:
  /// Poses older than this against the newest one are forgotten.
  static constexpr double kKept_s = 20.0;

  /// A pose that is not newer than the newest one changes nothing.
  void add(double stamp_s, const Eigen::Isometry3d& T_world_base);

  /// The pose then, between its neighbours in time; none before the first and after the newest.
  [[nodiscard]] std::optional<Eigen::Isometry3d> at(double stamp_s) const;

  /// The pose known nearest in time; none if there is no pose at all.
  [[nodiscard]] std::optional<Eigen::Isometry3d> nearest(double stamp_s) const;

  /// Shifts all poses.
  void move(const Shift& shift);
  void clear() { poses_.clear(); }

 private:
  struct Stamped {
    double stamp_s = 0.0;
    Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  };
  std::deque<Stamped> poses_;
};

}  // namespace spelunk::bridge
