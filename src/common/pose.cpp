#include "spelunk/common/pose.h"

namespace spelunk {

double wrapAngle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * M_PI);
  return wrapped <= -M_PI ? M_PI : wrapped;
}

Eigen::Isometry3d T_world_base(const Pose& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(pose.position);
  transform.rotate(Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()));
  return transform;
}

Pose poseOf(const Eigen::Isometry3d& T_world_base) {
  const Eigen::Vector3d forward = T_world_base.linear().col(0);
  return {T_world_base.translation(), std::atan2(forward.y(), forward.x())};
}

}  // namespace spelunk
