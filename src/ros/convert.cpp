#include "spelunk/ros/convert.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/ros/frame_names.h"

namespace spelunk::bridge {
namespace {

template <class Message>
Eigen::Vector3d vectorOf(const Message& message) {
  return {message.x, message.y, message.z};
}

geometry_msgs::Vector3 vectorMsg(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Quaternion quaternionMsg(const Eigen::Quaterniond& rotation) {
  geometry_msgs::Quaternion message;
  message.x = rotation.x();
  message.y = rotation.y();
  message.z = rotation.z();
  message.w = rotation.w();
  return message;
}

Eigen::Quaterniond turnBy(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

template <class T>
FromMsg<T> refused(const std::string& problem) {
  return {std::nullopt, problem};
}

std::string wrongFrame(const std::string& given, const std::string& wanted) {
  return "is in frame '" + given + "' but must be in '" + wanted + "'";
}

FromMsg<Eigen::Isometry3d> isometryOf(const Eigen::Vector3d& position,
                                      const geometry_msgs::Quaternion& rotation) {
  const Eigen::Quaterniond q(rotation.w, rotation.x, rotation.y, rotation.z);
  if (!position.allFinite() || !q.coeffs().allFinite())
    return refused<Eigen::Isometry3d>("holds a number that is not finite");
  if (q.norm() < 0.5)
    return refused<Eigen::Isometry3d>("has an orientation of zero length (quaternion not filled?)");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = position;
  return {T, ""};
}

FromMsg<TrajectoryPoint> pointOf(const trajectory_msgs::MultiDOFJointTrajectoryPoint& message,
                                 double start_s) {
  if (message.transforms.empty())
    return refused<TrajectoryPoint>("has a point without a transform");
  const auto& transform = message.transforms.front();
  const auto T_world_body = isometryOf(vectorOf(transform.translation), transform.rotation);
  if (!T_world_body.value) return refused<TrajectoryPoint>(T_world_body.problem);
  TrajectoryPoint point;
  point.time_s = start_s + message.time_from_start.toSec();
  point.pose = poseOf(*T_world_body.value);
  if (!message.velocities.empty()) {
    point.velocity = vectorOf(message.velocities.front().linear);
    point.yaw_rate = message.velocities.front().angular.z;
  }
  if (!message.accelerations.empty())
    point.acceleration = vectorOf(message.accelerations.front().linear);
  if (!point.velocity.allFinite() || !point.acceleration.allFinite() ||
      !std::isfinite(point.yaw_rate))
    return refused<TrajectoryPoint>("holds a number that is not finite");
  return {point, ""};
}

}  // namespace

geometry_msgs::Point toMsg(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

geometry_msgs::Pose toMsg(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position = toMsg(pose.position);
  message.orientation = quaternionMsg(turnBy(pose.yaw));
  return message;
}

nav_msgs::Path toMsg(const Path& path, const std::string& frame, const ::ros::Time& stamp) {
  nav_msgs::Path message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  for (const Pose& pose : path) {
    geometry_msgs::PoseStamped waypoint;
    waypoint.header = message.header;
    waypoint.pose = toMsg(pose);
    message.poses.push_back(waypoint);
  }
  return message;
}

trajectory_msgs::MultiDOFJointTrajectory toMsg(const Trajectory& trajectory,
                                               const std::string& frame, const ::ros::Time& start) {
  trajectory_msgs::MultiDOFJointTrajectory message;
  message.header.frame_id = frame;
  message.header.stamp = start;
  message.joint_names = {"base_link"};
  for (const TrajectoryPoint& point : trajectory) {
    trajectory_msgs::MultiDOFJointTrajectoryPoint entry;
    entry.time_from_start = ::ros::Duration(point.time_s - trajectory.front().time_s);
    geometry_msgs::Transform transform;
    transform.translation = vectorMsg(point.pose.position);
    transform.rotation = quaternionMsg(turnBy(point.pose.yaw));
    entry.transforms.push_back(transform);
    geometry_msgs::Twist velocity;
    velocity.linear = vectorMsg(point.velocity);
    velocity.angular.z = point.yaw_rate;
    entry.velocities.push_back(velocity);
    geometry_msgs::Twist acceleration;
    acceleration.linear = vectorMsg(point.acceleration);
    entry.accelerations.push_back(acceleration);
    message.points.push_back(entry);
  }
  return message;
}

nav_msgs::Odometry toMsg(const RobotState& state, const std::string& frame,
                         const std::string& body_frame, const ::ros::Time& stamp) {
  nav_msgs::Odometry message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  message.child_frame_id = body_frame;
  message.pose.pose.position = toMsg(state.pose.position);
  message.pose.pose.orientation = quaternionMsg(state.orientation);
  const Eigen::Quaterniond to_body = state.orientation.conjugate();
  message.twist.twist.linear = vectorMsg(to_body * state.velocity);
  message.twist.twist.angular = vectorMsg(to_body * Eigen::Vector3d(0.0, 0.0, state.yaw_rate));
  return message;
}

geometry_msgs::TransformStamped frameMsg(const LocalFrame& frame, const std::string& world,
                                         const std::string& local, const ::ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = world;
  message.header.stamp = stamp;
  message.child_frame_id = local;
  message.transform.translation = vectorMsg(frame.origin());
  message.transform.rotation =
      quaternionMsg(Eigen::Quaterniond(Eigen::AngleAxisd(frame.yaw(), Eigen::Vector3d::UnitZ())));
  return message;
}

FromMsg<Eigen::Isometry3d> fromMsg(const geometry_msgs::Pose& message) {
  return isometryOf(vectorOf(message.position), message.orientation);
}

FromMsg<Path> fromMsg(const nav_msgs::Path& message, const std::string& frame) {
  if (frameName(message.header.frame_id) != frameName(frame))
    return refused<Path>(wrongFrame(message.header.frame_id, frame));
  Path path;
  for (const geometry_msgs::PoseStamped& waypoint : message.poses) {
    const auto T_world_body = fromMsg(waypoint.pose);
    if (!T_world_body.value) return refused<Path>(T_world_body.problem);
    path.push_back(poseOf(*T_world_body.value));
  }
  return {path, ""};
}

FromMsg<Trajectory> fromMsg(const trajectory_msgs::MultiDOFJointTrajectory& message,
                            const std::string& frame) {
  if (frameName(message.header.frame_id) != frameName(frame))
    return refused<Trajectory>(wrongFrame(message.header.frame_id, frame));
  Trajectory trajectory;
  for (const auto& entry : message.points) {
    const auto point = pointOf(entry, message.header.stamp.toSec());
    if (!point.value) return refused<Trajectory>(point.problem);
    if (!trajectory.empty() && point.value->time_s <= trajectory.back().time_s)
      return refused<Trajectory>("has times that do not rise from point to point");
    trajectory.push_back(*point.value);
  }
  return {trajectory, ""};
}

FromMsg<RobotState> fromMsg(const nav_msgs::Odometry& message,
                            const Eigen::Isometry3d& T_world_frame) {
  const auto T_frame_base = fromMsg(message.pose.pose);
  if (!T_frame_base.value) return refused<RobotState>(T_frame_base.problem);
  const Eigen::Vector3d linear = vectorOf(message.twist.twist.linear);
  const Eigen::Vector3d angular = vectorOf(message.twist.twist.angular);
  if (!linear.allFinite() || !angular.allFinite())
    return refused<RobotState>("holds a velocity that is not finite");
  const Eigen::Isometry3d T = T_world_frame * *T_frame_base.value;
  RobotState state;
  state.stamp_s = message.header.stamp.toSec();
  state.pose = poseOf(T);
  state.orientation = Eigen::Quaterniond(T.linear());
  state.velocity = T.linear() * linear;
  state.yaw_rate = (T.linear() * angular).z();
  return {state, ""};
}

RobotState ofBase(const RobotState& child, const Eigen::Isometry3d& T_child_base) {
  const Eigen::Isometry3d T_world_child =
      Eigen::Translation3d(child.pose.position) * child.orientation;
  const Eigen::Isometry3d T = T_world_child * T_child_base;
  RobotState base = child;
  base.pose = poseOf(T);
  base.orientation = Eigen::Quaterniond(T.linear());
  const Eigen::Vector3d lever = T.translation() - child.pose.position;
  base.velocity += Eigen::Vector3d(0.0, 0.0, child.yaw_rate).cross(lever);
  return base;
}

FromMsg<AxisAlignedBox> boundsFromMsg(const geometry_msgs::Point& min,
                                      const geometry_msgs::Point& max) {
  const AxisAlignedBox box{vectorOf(min), vectorOf(max)};
  if (box.min.array().isNaN().any() || box.max.array().isNaN().any())
    return refused<AxisAlignedBox>("bounds hold NaN; use +-inf for an open side");
  if (box.isEmpty()) return refused<AxisAlignedBox>("bounds are empty: min must not exceed max");
  return {box, ""};
}

FromMsg<std::vector<NoGoZone>> fromMsg(const SetNoGoZones::Request& request) {
  using Zones = std::vector<NoGoZone>;
  const std::size_t count = request.polygons.size();
  if (request.names.size() != count || request.z_min.size() != count ||
      request.z_max.size() != count)
    return refused<Zones>("names, polygons, z_min and z_max must have the same number of entries");
  Zones zones;
  for (std::size_t i = 0; i < count; ++i) {
    NoGoZone zone{request.names[i], {}, request.z_min[i], request.z_max[i]};
    if (std::isnan(zone.z_min) || std::isnan(zone.z_max) || zone.z_min > zone.z_max)
      return refused<Zones>("zone '" + zone.name + "': z_min must not exceed z_max");
    for (const geometry_msgs::Point32& corner : request.polygons[i].points) {
      if (!std::isfinite(corner.x) || !std::isfinite(corner.y))
        return refused<Zones>("zone '" + zone.name + "' has a corner that is not finite");
      zone.polygon.emplace_back(corner.x, corner.y);
    }
    if (zone.polygon.size() < 3)
      return refused<Zones>("zone '" + zone.name + "' has fewer than three corners");
    zones.push_back(std::move(zone));
  }
  return {zones, ""};
}

double cornerError(const SetNoGoZones::Request& request) {
  float farthest = 0.0F;
  for (const geometry_msgs::Polygon& polygon : request.polygons)
    for (const geometry_msgs::Point32& corner : polygon.points)
      farthest = std::max({farthest, std::fabs(corner.x), std::fabs(corner.y)});
  return 0.5 * (std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest);
}

FromMsg<double> remainingFromMsg(const sensor_msgs::BatteryState& message, double endurance_s) {
  double remaining_s = std::numeric_limits<double>::infinity();
  const double percentage = message.percentage;  // 0 .. 1 by the message's definition.
  if (percentage >= 0.0 && percentage <= 1.0) remaining_s = percentage * endurance_s;
  const double charge_ah = message.charge;
  const double current_a = message.current;  // Negative while discharging.
  if (charge_ah >= 0.0 && current_a < 0.0)
    remaining_s = std::min(remaining_s, charge_ah / -current_a * 3600.0);
  if (!std::isfinite(remaining_s))
    return refused<double>("holds neither a percentage in 0..1 nor charge with a current below 0");
  return {remaining_s, ""};
}

}  // namespace spelunk::bridge
