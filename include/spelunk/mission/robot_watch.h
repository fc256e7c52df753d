#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>

#include "spelunk/common/robot_model.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/mission/input_guard.h"

namespace spelunk::mission {

/// Sensors that are silent for longer have stopped, seconds: the fastest of them leaves out several
/// scans.
[[nodiscard]] double scanSilence(const RobotModel& robot);

/// What the robot reports of itself, and whether that can be relied upon: odometry that is odd,
/// late or silent, scans that are, and a fall. Poses are those of the centre of the robot's box
/// unless they are called the base's. Times are mission time, seconds.
class RobotWatch {
 public:
  explicit RobotWatch(const RobotModel& robot);

  /// Takes up the state of the base. None if it is good; else what is wrong with it: it is not
  /// used.
  std::optional<std::string> takeOdometry(const RobotState& base, double now_s);
  /// What is wrong with a scan, if anything.
  [[nodiscard]] std::optional<std::string> faultOf(const Scan& scan, double now_s) const;
  /// Notes a good scan. False if it follows too soon after the last one that was mapped.
  bool takesScan(const Scan& scan, double now_s);
  void noteMapped(const Scan& scan);

  /// Whether there has been any good odometry; what follows asks for it first.
  [[nodiscard]] bool knowsPose() const { return input_.latest().has_value(); }
  /// Now: as it was reported, moved on since by show().
  [[nodiscard]] const RobotState& state() const { return shown_; }
  [[nodiscard]] const RobotState& reported() const { return *input_.latest(); }
  /// Where the robot is now, between two reports of odometry.
  void show(const RobotState& state) { shown_ = state; }
  /// Until then after the newest report it is known how the robot has moved on, mission time.
  [[nodiscard]] double knownUntil() const;
  /// Between two reports of odometry of late, seconds; 0 before the second one.
  [[nodiscard]] double odometryPeriod() const { return odometry_period_s_; }
  [[nodiscard]] const Pose& pose() const { return state().pose; }
  [[nodiscard]] std::optional<Eigen::Vector3d> position() const;
  [[nodiscard]] Pose basePose() const;
  [[nodiscard]] const Eigen::Isometry3d& T_world_base() const { return T_world_base_; }

  /// Why the inputs cannot be relied upon now; empty if they can.
  [[nodiscard]] std::string problem(double now_s) const;
  /// How old the newest mapped scan is, seconds.
  [[nodiscard]] double scanAge(double now_s) const;
  [[nodiscard]] int mappedScans() const { return mapped_scans_; }
  [[nodiscard]] double distance_m() const { return distance_m_; }

  /// Whether a robot with legs is tilted as no slope tilts it.
  [[nodiscard]] bool isTilted() const { return tilted_since_s_.has_value(); }
  /// One sentence if it has been tilted too long for a stumble.
  [[nodiscard]] std::optional<std::string> fall() const;

 private:
  void watchTilt(const RobotState& base);
  void notePeriod(double stamp_s);
  void countReturns(const Scan& scan);
  [[nodiscard]] const SensorModel* modelOf(const Scan& scan) const;
  [[nodiscard]] double odometrySilence() const;

  RobotModel robot_;
  InputGuard input_;
  double scan_period_s_;                    ///< Of the fastest sensor.
  double scan_silence_s_;                   ///< Longer silence means that the sensors have stopped.
  std::optional<std::string> input_fault_;  ///< Of the newest odometry.
  std::optional<double> last_odometry_s_;   ///< When it came in.
  Pose last_pose_;                          ///< Of the newest good odometry.
  double distance_m_ = 0.0;
  Eigen::Isometry3d T_world_base_ = Eigen::Isometry3d::Identity();
  std::optional<double> last_scan_s_;  ///< When it came in.
  double newest_scan_s_ = 0.0;         ///< When it was taken.
  double newest_mapped_s_ = 0.0;       ///< The same of the newest one that was mapped.
  int mapped_scans_ = 0;
  RobotState shown_;
  std::optional<double> last_stamp_s_;  ///< Of good odometry.
  double odometry_period_s_ = 0.0;
  std::optional<double> few_since_s_;  ///< Too few rays come back from every sensor.
  std::string few_text_;
  std::map<std::string, ScanThinning> thinnings_;  ///< By sensor.
  std::optional<double> tilted_since_s_;
  double tilted_for_s_ = 0.0;
  double upright_ = 1.0;  ///< Cosine of the tilt.
};

}  // namespace spelunk::mission
