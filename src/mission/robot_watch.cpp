#include "spelunk/mission/robot_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "spelunk/common/message_text.h"

namespace spelunk::mission {
namespace {

/// An estimator or a sensor that is silent for so long has stopped.
constexpr double kInputSilence_s = 1.0;
/// A sensor that is slower than that has stopped when it leaves out so many scans.
constexpr double kScansMissed = 3.0;
/// A robot that sees what was so long ago, the time between two scans apart, cannot stop before
/// what is there now.
constexpr double kScanLateMax_s = 2.0;
/// Clocks of computers that are kept in step differ by far less.
constexpr double kScanFuture_s = 1.0;
constexpr double kFallenTilt_deg = 50.0;  // no slope that a robot walks on tilts it so far
constexpr double kFallenTime_s = 0.3;     // a stumble is shorter

/// Returns on an obstacle that surely enter the map.
constexpr double kHitsNeeded = 3.0;
constexpr double kPeriodShare = 0.2;           // of the newest step in the mean
constexpr double kOdometrySilenceMax_s = 5.0;  // nothing that flies waits longer

/// Of the rays of a sensor, those that meet an obstacle as large as the robot where it would have
/// to stop.
double shareOfObstacle(const SensorModel& sensor, const RobotModel& robot) {
  const double away_m = 0.5 * robot.box_m.x() + brakingDistance(robot, robot.speed_max_mps);
  const auto degrees = [&](double size_m) {
    return 2.0 * std::atan2(0.5 * size_m, away_m) * 180.0 / M_PI;
  };
  return std::min(1.0, degrees(robot.box_m.y()) / sensor.fov_horizontal_deg) *
         std::min(1.0, degrees(robot.box_m.z()) / verticalField(sensor).width());
}

/// Between two scans of the fastest sensor, seconds; 0 where none is described.
double scanPeriodOf(const RobotModel& robot) {
  double rate_hz = 0.0;
  for (const SensorModel& sensor : robot.sensor_models) rate_hz = std::max(rate_hz, sensor.rate_hz);
  return rate_hz > 0.0 ? 1.0 / rate_hz : 0.0;
}

}  // namespace

double scanSilence(const RobotModel& robot) {
  return std::max(kInputSilence_s, kScansMissed * scanPeriodOf(robot));
}

RobotWatch::RobotWatch(const RobotModel& robot)
    : robot_(robot),
      input_(robot.speed_max_mps),
      scan_period_s_(scanPeriodOf(robot)),
      scan_silence_s_(scanSilence(robot)) {}

std::optional<std::string> RobotWatch::takeOdometry(const RobotState& base, double now_s) {
  RobotState report = base;
  report.pose.position.z() += robot_.box_lift_m;
  if (const auto fault = input_.check(report)) return input_fault_ = fault;
  notePeriod(report.stamp_s);
  shown_ = report;
  if (!input_fault_ && last_odometry_s_) distance_m_ += distance(last_pose_, report.pose);
  last_pose_ = report.pose;
  input_fault_.reset();
  last_odometry_s_ = std::max(now_s, report.stamp_s);
  T_world_base_ = Eigen::Translation3d(base.pose.position) * base.orientation;
  watchTilt(base);
  return std::nullopt;
}

/// The longest of late counts: it is what the robot flies without knowing.
void RobotWatch::notePeriod(double stamp_s) {
  if (last_stamp_s_ && stamp_s > *last_stamp_s_) {
    const double step_s = std::min(stamp_s - *last_stamp_s_, odometrySilence());
    odometry_period_s_ =
        std::max(step_s, odometry_period_s_ + kPeriodShare * (step_s - odometry_period_s_));
  }
  last_stamp_s_ = stamp_s;
}

double RobotWatch::odometrySilence() const {
  return std::clamp(kScansMissed * odometry_period_s_, kInputSilence_s, kOdometrySilenceMax_s);
}

double RobotWatch::knownUntil() const { return reported().stamp_s + odometrySilence(); }

const SensorModel* RobotWatch::modelOf(const Scan& scan) const {
  for (const SensorModel& model : robot_.sensor_models)
    if (model.name == scan.sensor) return &model;
  return robot_.sensor_models.size() == 1 ? &robot_.sensor_models.front() : nullptr;
}

/// Flight needs to see an obstacle as large as the robot where it would have to stop. Where the
/// rays that come back are spread over the field of view, some of them must fall on it. Wide halls
/// and portals, where most rays meet nothing, leave far more than that.
void RobotWatch::countReturns(const Scan& scan) {
  const SensorModel* sensor = modelOf(scan);
  if (sensor == nullptr || sensor->reports_misses) return few_since_s_.reset();
  const auto came_back = static_cast<double>(scan.points.size());
  const double needed = std::ceil(kHitsNeeded / shareOfObstacle(*sensor, robot_));
  if (came_back >= needed) return few_since_s_.reset();
  if (!few_since_s_) few_since_s_ = scan.stamp_s;
  const double rays = static_cast<double>(sensor->rows) * sensor->columns;
  char text[300];
  std::snprintf(text, sizeof text,
                "too few returns to fly by: %.0f of the %.0f rays of %s come back (%.2g %%), an "
                "obstacle ahead is seen with %.0f or more: check the sensor, its cover, dust or "
                "fog, and rows and columns in its file",
                came_back, rays, sensor->name.c_str(), 100.0 * came_back / rays, needed);
  few_text_ = text;
}

/// Told by the tilt alone: a robot that lies on its side for some time is not walking any more.
void RobotWatch::watchTilt(const RobotState& base) {
  if (kindOf(robot_) != RobotKind::kLegged) return;
  upright_ = (base.orientation * Eigen::Vector3d::UnitZ()).z();
  if (upright_ > std::cos(kFallenTilt_deg * M_PI / 180.0)) return tilted_since_s_.reset();
  if (!tilted_since_s_) tilted_since_s_ = base.stamp_s;
  tilted_for_s_ = base.stamp_s - *tilted_since_s_;
}

std::optional<std::string> RobotWatch::fall() const {
  if (!tilted_since_s_ || tilted_for_s_ < kFallenTime_s) return std::nullopt;
  return withNumber("the robot has fallen (tilted by %.0f degrees): help it up",
                    std::acos(std::clamp(upright_, -1.0, 1.0)) * 180.0 / M_PI);
}

std::optional<std::string> RobotWatch::faultOf(const Scan& scan, double now_s) const {
  if (!std::isfinite(scan.stamp_s) || !scan.T_world_sensor.matrix().allFinite())
    return "a scan's stamp or pose is not finite: check tf";
  if (scan.stamp_s > now_s + kScanFuture_s && last_scan_s_)
    return "a scan's stamp lies in the future: check the clocks";
  if (scan.points.empty()) return "a scan without points: check the sensor";
  return std::nullopt;
}

/// Scans of sensors the robot's description does not name are all mapped.
bool RobotWatch::takesScan(const Scan& scan, double now_s) {
  last_scan_s_ = std::max(now_s, scan.stamp_s);
  newest_scan_s_ = std::max(newest_scan_s_, scan.stamp_s);
  countReturns(scan);
  double period_s = 0.0;
  for (const SensorModel& model : robot_.sensor_models)
    if (model.name == scan.sensor) period_s = model.mapping_period_s;
  return thinnings_.try_emplace(scan.sensor, period_s).first->second.takes(scan.stamp_s);
}

void RobotWatch::noteMapped(const Scan& scan) {
  newest_mapped_s_ = std::max(newest_mapped_s_, scan.stamp_s);
  ++mapped_scans_;
}

std::optional<Eigen::Vector3d> RobotWatch::position() const {
  if (!knowsPose()) return std::nullopt;
  return pose().position;
}

Pose RobotWatch::basePose() const {
  Pose base = pose();
  base.position.z() -= robot_.box_lift_m;
  return base;
}

std::string RobotWatch::problem(double now_s) const {
  if (input_fault_) return *input_fault_;
  if (!last_odometry_s_) return "no odometry yet: check the state estimation";
  if (now_s - *last_odometry_s_ > odometrySilence())
    return withNumber("no odometry for more than %.3g s: check the state estimation",
                      odometrySilence());
  if (!last_scan_s_) return "";
  if (now_s - *last_scan_s_ > scan_silence_s_)
    return withNumber("no scan for more than %.3g s: check the sensor", scan_silence_s_);
  if (few_since_s_ && newest_scan_s_ - *few_since_s_ >= scan_silence_s_) return few_text_;
  const double late_s = now_s - newest_scan_s_;
  if (late_s > kScanLateMax_s + scan_period_s_)
    return withNumber("scans come in %.1f s late: the computer or the network is overloaded",
                      late_s);
  return "";
}

double RobotWatch::scanAge(double now_s) const { return std::max(0.0, now_s - newest_mapped_s_); }

}  // namespace spelunk::mission
