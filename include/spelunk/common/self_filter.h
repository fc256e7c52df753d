#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/robot_model.h"

namespace spelunk {

/// The boxes of RobotModel::self_filter_boxes_m in the base frame. Entries that cannot be read are
/// added to `problems` (if given), one sentence each.
[[nodiscard]] std::vector<AxisAlignedBox> selfFilterBoxes(const RobotModel& robot,
                                                          std::vector<std::string>* problems);

/// Takes a robot's own parts (arms, legs, mast, cage) out of its scans.
class SelfFilter {
 public:
  /// Precondition: the robot's description has no problems.
  explicit SelfFilter(const RobotModel& robot) : boxes_(selfFilterBoxes(robot, nullptr)) {}

  /// `points` (sensor frame) but those in a box, in their order.
  [[nodiscard]] std::vector<Eigen::Vector3f> without(std::vector<Eigen::Vector3f> points,
                                                     const Eigen::Isometry3d& T_base_sensor) const;

 private:
  std::vector<AxisAlignedBox> boxes_;
};

}  // namespace spelunk
