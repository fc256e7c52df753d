#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/robot_model.h"

namespace spelunk {

/// What RobotModel::self_filter_boxes_m says.
struct SelfFilterBoxes {
  std::vector<AxisAlignedBox> boxes;  ///< In the base frame; none if there is a problem.
  std::string problem;                ///< Why it cannot be read, one sentence; empty if it can.
};
[[nodiscard]] SelfFilterBoxes selfFilterBoxes(const RobotModel& robot);

/// Takes a robot's own parts (arms, legs, mast, cage) out of its scans.
class SelfFilter {
 public:
  /// Precondition: the robot's description has no problems.
  explicit SelfFilter(const RobotModel& robot) : boxes_(selfFilterBoxes(robot).boxes) {}

  /// `points` (sensor frame) but those in a box, in their order.
  [[nodiscard]] std::vector<Eigen::Vector3f> without(std::vector<Eigen::Vector3f> points,
                                                     const Eigen::Isometry3d& T_base_sensor) const;

 private:
  std::vector<AxisAlignedBox> boxes_;
};

}  // namespace spelunk
