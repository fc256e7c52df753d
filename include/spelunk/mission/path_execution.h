#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "spelunk/common/path.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/map/occupancy.h"
#include "spelunk/navigation/path_monitor.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// A path being flown: where the robot is to be when, and whether the rest of it is still clear.
/// Arc lengths count along the timed line, which is what is really flown.
class PathExecution {
 public:
  /// `box`: what has to stay clear along the line, full extents, metres. The trajectory must not be
  /// empty.
  PathExecution(Path waypoints, Trajectory trajectory, planners::PathKind kind,
                const Eigen::Vector3d& box, double resolution_m);

  [[nodiscard]] const Path& waypoints() const { return waypoints_; }
  [[nodiscard]] const Trajectory& trajectory() const { return trajectory_; }
  [[nodiscard]] planners::PathKind kind() const { return kind_; }
  [[nodiscard]] const Eigen::Vector3d& box() const { return box_; }
  [[nodiscard]] double endTime() const { return trajectory_.back().time_s; }
  [[nodiscard]] double length() const { return arc_m_.back(); }

  [[nodiscard]] TrajectoryPoint reference(double time_s) const;
  [[nodiscard]] double arcAt(double time_s) const;
  /// Arc length of the place between two arc lengths, about, that is nearest to a position.
  [[nodiscard]] double nearestArc(const Eigen::Vector3d& position, double from_m,
                                  double to_m) const;
  /// The timed line between two arc lengths.
  [[nodiscard]] Path line(double from_m, double to_m) const;

  /// Notes voxels that became occupied.
  void noteOccupied(const std::vector<map::VoxelIndex>& voxels, double now_s);
  /// Arc length where the line is blocked, if it is.
  [[nodiscard]] const std::optional<double>& blockedAt() const { return blocked_arc_m_; }
  void setBlockedAt(double arc_m) { blocked_arc_m_ = arc_m; }
  void clearBlock() { blocked_arc_m_.reset(); }

 private:
  Path waypoints_;
  Trajectory trajectory_;
  planners::PathKind kind_;
  Eigen::Vector3d box_;
  Path line_;
  std::vector<double> arc_m_;
  navigation::PathMonitor monitor_;
  std::optional<double> blocked_arc_m_;
};

}  // namespace spelunk::mission
