#include "spelunk/ros/convert_robot.h"

#include <cmath>

namespace spelunk::bridge {

sensor_msgs::JointState toMsg(const sim::JointState& joints, const ::ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = joints.names;
  message.position = joints.angles;
  return message;
}

Eigen::Isometry3d T_world_body(const RobotState& state) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = state.orientation.toRotationMatrix();
  T.translation() = state.pose.position;
  return T;
}

FromMsg<sim::DriveCommand> fromMsg(const geometry_msgs::Twist& message) {
  for (const double part : {message.linear.x, message.linear.y, message.linear.z, message.angular.x,
                            message.angular.y, message.angular.z})
    if (!std::isfinite(part)) return {std::nullopt, "holds a number that is not finite"};
  return {sim::DriveCommand{message.linear.x, message.linear.y, message.angular.z}, ""};
}

std::vector<visualization::FootMark> marksOf(const std::vector<sim::FootState>& feet,
                                             const Eigen::Isometry3d& T_world_base) {
  std::vector<visualization::FootMark> marks;
  for (const sim::FootState& foot : feet)
    marks.push_back({T_world_base * foot.position, foot.is_in_contact});
  return marks;
}

}  // namespace spelunk::bridge
