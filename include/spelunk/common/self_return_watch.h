#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/robot_model.h"

namespace spelunk {

/// Notices returns from the robot's own parts in the scans of one sensor: what is near, stays at
/// the same place of the robot from scan to scan, and is not there any more where the robot was.
/// A wall or floor beside which it moves also stays beside it, but is still seen where it was. Two
/// motions in a row have to show it: the rim of a wall is taken for a part once in a while.
/// Returns that the map drops anyway (too near the sensor, inside the body) do not count.
/// Not thread-safe.
class SelfReturnWatch {
 public:
  /// `range_min_m`: the map's.
  SelfReturnWatch(const RobotModel& robot, double range_min_m);

  /// A scan: points in the sensor frame, what a self filter takes out left out.
  void look(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_base_sensor,
            const Eigen::Isometry3d& T_world_base);

  /// What is to be said at once: returns that were proved to move with the robot, or, before it has
  /// moved, lie inside its safety box. One sentence with distances and remedy; empty if none.
  [[nodiscard]] const std::string& finding() const { return finding_; }

  /// What explains a robot that cannot leave its place: the finding, or else near returns at its
  /// height that may be walls or its own parts. Empty if none.
  [[nodiscard]] const std::string& doubt() const { return finding_.empty() ? doubt_ : finding_; }

 private:
  using Cell = std::array<int, 3>;  ///< Of a grid in the base frame.
  struct Hits {
    int scans = 0;
    Eigen::Vector3d p_base = Eigen::Vector3d::Zero();  ///< The newest one.
  };
  struct Spread {  ///< Of some cells.
    double nearest_m = 0.0;
    double farthest_m = 0.0;
    std::string box;  ///< Around them, as self_filter_boxes_m wants it.
  };

  void count(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_base_sensor);
  [[nodiscard]] bool isSteady(const Hits& hits) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> steadyPlaces() const;
  [[nodiscard]] std::vector<Eigen::Vector3d> ownPlaces(const std::vector<Eigen::Vector3f>& points,
                                                       const Eigen::Isometry3d& T_base_sensor,
                                                       const Eigen::Isometry3d& T_world_base) const;
  [[nodiscard]] Spread spreadOf(const std::vector<Eigen::Vector3d>& places,
                                const Eigen::Isometry3d& T_base_sensor) const;
  [[nodiscard]] std::string remedyFor(const Spread& spread) const;
  void beginAnew(const Eigen::Isometry3d& T_world_base);
  void judgeAtRest(const Eigen::Isometry3d& T_base_sensor);
  void judgeAfterMotion(const std::vector<Eigen::Vector3f>& points,
                        const Eigen::Isometry3d& T_base_sensor,
                        const Eigen::Isometry3d& T_world_base);

  RobotModel robot_;
  double range_min_m_;
  double reach_m_;  ///< From the base: farther returns are not looked at.
  std::map<Cell, Hits> cells_;
  int scans_ = 0;  ///< Since the anchor.
  bool has_moved_ = false;
  std::vector<Eigen::Vector3d> suspected_;           ///< Own places by the last motion, base frame.
  std::optional<Eigen::Isometry3d> T_world_anchor_;  ///< The base when counting began.
  std::string finding_;
  std::string doubt_;
};

}  // namespace spelunk
