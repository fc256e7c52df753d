#include "spelunk/ros/cloud_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spelunk/common/message_text.h"
#include "spelunk/ros/frame_names.h"

namespace spelunk::bridge {
namespace {

constexpr double kMotionVoxels = 2.0;  // less than that, a ray from the wrong place does no harm
constexpr double kSlack_m = 1.0;       // between odometry and tf: corrections of an estimator

/// No sensor of this robot is farther from its base.
double mountingReach(const RobotModel& robot) {
  double mount_m = 0.0;
  for (const SensorModel& sensor : robot.sensor_models)
    mount_m = std::max(mount_m, T_base_sensor(sensor).translation().norm());
  return robot.box_m.norm() + std::abs(robot.box_lift_m) + mount_m;
}

std::string metres(double value) { return withNumber("%.1f m", value); }

std::string namesOf(const RobotModel& robot) {
  std::string names;
  for (const SensorModel& sensor : robot.sensor_models)
    names += (names.empty() ? "" : ", ") + sensor.name;
  return names;
}

}  // namespace

CloudPlaces::CloudPlaces(const RobotModel& robot, const std::string& world_frame,
                         double resolution_m, const std::string& registered_sensor, FrameTree tree,
                         const std::string& frame_prefix)
    : robot_(robot),
      registered_sensor_(registered_sensor),
      frame_prefix_(frame_prefix),
      reach_m_(mountingReach(robot)),
      tree_(std::move(tree)),
      bonds_(world_frame, reach_m_, kMotionVoxels * resolution_m, tree_.parent) {}

void CloudPlaces::onOdometry(const std::string& frame, const std::string& base_frame,
                             double stamp_s, const Eigen::Isometry3d& T_world_base) {
  bonds_.noteOdometry(frame, base_frame);
  track_.add(stamp_s, T_world_base);
}

void CloudPlaces::forget() {
  bonds_.forget();
  track_.clear();
}

std::vector<std::string> CloudPlaces::news() { return std::exchange(news_, {}); }

FromMsg<CloudPlace> CloudPlaces::find(const std::string& frame, const ::ros::Time& stamp) {
  const auto T_world_frame = tree_.T_world_frame(frame, stamp);
  if (!T_world_frame.value) return {std::nullopt, T_world_frame.problem};
  const auto T_world_base = track_.nearest(stamp.toSec());
  if (!T_world_base)
    return {std::nullopt,
            "no odometry yet, which tells whether the robot carries this frame: publish odometry"};
  if (bonds_.bondOf(frame, *T_world_frame.value, *T_world_base) == FrameBond::kFixed)
    return findRegistered(frame, stamp, *T_world_frame.value);
  return findCarried(frame, *T_world_frame.value, *T_world_base);
}

FromMsg<CloudPlace> CloudPlaces::findCarried(const std::string& frame,
                                             const Eigen::Isometry3d& T_world_frame,
                                             const Eigen::Isometry3d& T_world_base) const {
  const double gap_m = (T_world_frame.translation() - T_world_base.translation()).norm();
  if (gap_m > reach_m_ + kSlack_m)
    return {std::nullopt, "tf has this frame " + metres(gap_m) +
                              " from where odometry has the robot, but no sensor of it can be " +
                              "farther than " + metres(reach_m_ + kSlack_m) +
                              " away: let one source publish both tf and odometry, and check "
                              "robot.box_m and the sensor's transform"};
  CloudPlace place;
  if (const SensorModel* sensor = sensorNamed(withoutPrefix(frame_prefix_, frame)))
    place.sensor = sensor->name;
  place.T_world_sensor = T_world_frame;
  place.T_base_sensor = T_world_base.inverse() * T_world_frame;
  return {place, ""};
}

FromMsg<CloudPlace> CloudPlaces::findRegistered(const std::string& frame, const ::ros::Time& stamp,
                                                const Eigen::Isometry3d& T_world_frame) {
  const SensorModel* sensor = sensorOfRegistered();
  if (sensor == nullptr)
    return {std::nullopt,
            "this frame does not move with the robot, and it is not known which of its sensors (" +
                namesOf(robot_) +
                ") took the cloud: name it in cloud/registered_sensor, or remap 'pointcloud' to "
                "the cloud in the sensor's own frame"};
  const auto T_world_base = track_.at(stamp.toSec());
  if (!T_world_base)
    return {std::nullopt,
            "this frame does not move with the robot, and no odometry came from before and after "
            "the cloud: publish odometry at least as often as clouds, stamped by the same clock"};
  CloudPlace place;
  place.sensor = sensor->name;
  place.T_base_sensor = T_base_sensor(*sensor);
  place.T_world_sensor = *T_world_base * place.T_base_sensor;
  place.T_sensor_cloud = place.T_world_sensor.inverse() * T_world_frame;
  if (registered_frames_.insert(frame).second)
    news_.push_back("clouds in frame '" + frame +
                    "' are registered: the frame does not move with the robot. Their rays are "
                    "taken to begin at sensor." +
                    sensor->name + ".mount_m " + spelunk::toText(sensor->mount_m) +
                    " of the base that odometry reports; correct that if the sensor is elsewhere");
  return {place, ""};
}

const SensorModel* CloudPlaces::sensorNamed(const std::string& name) const {
  for (const SensorModel& sensor : robot_.sensor_models)
    if (sensor.name == name) return &sensor;
  return nullptr;
}

const SensorModel* CloudPlaces::sensorOfRegistered() const {
  if (!registered_sensor_.empty()) return sensorNamed(registered_sensor_);
  if (robot_.sensor_models.size() == 1) return &robot_.sensor_models.front();
  const SensorModel* only = nullptr;
  for (const SensorModel& sensor : robot_.sensor_models) {
    if (kindOf(sensor) != SensorKind::kLidar) continue;
    if (only != nullptr) return nullptr;
    only = &sensor;
  }
  return only;
}

}  // namespace spelunk::bridge
