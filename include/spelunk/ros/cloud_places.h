#pragma once

#include <ros/time.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "spelunk/common/robot_model.h"
#include "spelunk/ros/convert.h"
#include "spelunk/ros/frame_bond.h"
#include "spelunk/ros/pose_track.h"

namespace spelunk::bridge {

/// Where a cloud was taken from.
struct CloudPlace {
  std::string sensor;  ///< The sensor's name in the robot's description; empty: none of them.
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_base_sensor = Eigen::Isometry3d::Identity();
  /// Brings the cloud's points into the sensor frame; the identity unless the cloud is registered.
  Eigen::Isometry3d T_sensor_cloud = Eigen::Isometry3d::Identity();
};

/// What tf says.
struct FrameTree {
  /// World from a frame at a time (0: the newest), or why there is none: a sentence and the remedy.
  std::function<FromMsg<Eigen::Isometry3d>(const std::string& frame, const ::ros::Time& stamp)>
      T_world_frame;
  FrameBonds::ParentLookup parent;
};

/// Finds where each cloud was taken from. Where its frame is carried by the robot, tf says so. A
/// registered cloud (FAST-LIO's `cloud_registered`) comes in a frame that stays in the world: its
/// sensor was where odometry and the robot's description say. Clouds whose place cannot be told for
/// sure are refused with the remedy. Not thread-safe.
class CloudPlaces {
 public:
  /// `registered_sensor`: the sensor of registered clouds; empty: the only LiDAR of the robot.
  /// `frame_prefix`: before the names of the robot's sensors in tf.
  CloudPlaces(const RobotModel& robot, const std::string& world_frame, double resolution_m,
              const std::string& registered_sensor, FrameTree tree,
              const std::string& frame_prefix = {});

  /// Good odometry, in the world; `frame` and `base_frame` as its message names them.
  void onOdometry(const std::string& frame, const std::string& base_frame, double stamp_s,
                  const Eigen::Isometry3d& T_world_base);

  /// The world was corrected by tf: where the robot was before lies elsewhere in it.
  void correct(const Shift& correction) { track_.move(correction); }

  /// `frame` without leading slashes. No place: it may be there later; `problem` holds the remedy.
  [[nodiscard]] FromMsg<CloudPlace> find(const std::string& frame, const ::ros::Time& stamp);

  /// One sentence for each frame that has turned out to be registered since the last call.
  [[nodiscard]] std::vector<std::string> news();

  void forget();

 private:
  [[nodiscard]] FromMsg<CloudPlace> findCarried(const std::string& frame,
                                                const Eigen::Isometry3d& T_world_frame,
                                                const Eigen::Isometry3d& T_world_base) const;
  [[nodiscard]] FromMsg<CloudPlace> findRegistered(const std::string& frame,
                                                   const ::ros::Time& stamp,
                                                   const Eigen::Isometry3d& T_world_frame);
  [[nodiscard]] const SensorModel* sensorNamed(const std::string& name) const;
  [[nodiscard]] const SensorModel* sensorOfRegistered() const;

  RobotModel robot_;
  std::string registered_sensor_;
  std::string frame_prefix_;
  double reach_m_;
  FrameTree tree_;
  FrameBonds bonds_;
  PoseTrack track_;
  std::set<std::string> registered_frames_;
  std::vector<std::string> news_;
};

}  // namespace spelunk::bridge
