#include "spelunk/common/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace spelunk {
namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Vector3f lidarRay(const SensorModel& sensor, int row, int column) {
  const VerticalField field = verticalField(sensor);
  const double horizontal = sensor.fov_horizontal_deg * kDegree;
  const double elevation = sensor.rows == 1 ? field.middle() * kDegree
                                            : field.lower_deg * kDegree +
                                                  field.width() * kDegree * row / (sensor.rows - 1);
  const bool is_full_circle = sensor.fov_horizontal_deg >= 360.0;
  const int gaps = is_full_circle ? sensor.columns : std::max(1, sensor.columns - 1);
  const double azimuth = -0.5 * horizontal + horizontal * column / gaps;
  return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
      .cast<float>();
}

Eigen::Vector3f pixelRay(const SensorModel& sensor, int row, int column) {
  const double half_width = std::tan(0.5 * sensor.fov_horizontal_deg * kDegree);
  const VerticalField field = verticalField(sensor);
  const double top = std::tan(field.upper_deg * kDegree);
  const double bottom = std::tan(field.lower_deg * kDegree);
  const double left = half_width * (1.0 - 2.0 * (column + 0.5) / sensor.columns);
  const double up =
      0.5 * (top + bottom) + 0.5 * (top - bottom) * (2.0 * (row + 0.5) / sensor.rows - 1.0);
  return Eigen::Vector3d(1.0, left, up).normalized().cast<float>();
}

/// "sensor.lidar_16.rows = 16"
std::string named(const SensorModel& sensor, const char* field, double value) {
  return "sensor." + sensor.name + "." + field + " = " + toText(value);
}

void addFieldProblems(const SensorModel& sensor, std::vector<std::string>& found) {
  constexpr double kSame_deg = 1e-6;
  constexpr double kCameraLimit_deg = 85.0;  // a plane of pixels has no place for steeper ones
  const bool has_limits = sensor.fov_lower_deg != 0.0 || sensor.fov_upper_deg != 0.0;
  const VerticalField field = verticalField(sensor);
  const std::string limits = named(sensor, "fov_lower_deg", sensor.fov_lower_deg) +
                             " and fov_upper_deg = " + toText(sensor.fov_upper_deg);
  if (has_limits && sensor.fov_lower_deg >= sensor.fov_upper_deg)
    found.push_back(limits + ": the lower limit must lie below the upper one");
  else if (has_limits && sensor.fov_vertical_deg > 0.0 &&
           std::fabs(field.width() - sensor.fov_vertical_deg) > kSame_deg)
    found.push_back(limits + " make " + toText(field.width()) +
                    " degrees, but fov_vertical_deg = " + toText(sensor.fov_vertical_deg) +
                    ": leave fov_vertical_deg out (or set it to 0), or leave both limits out");
  const double steepest = std::max(std::fabs(field.lower_deg), std::fabs(field.upper_deg));
  if (kindOf(sensor) == SensorKind::kDepthCamera &&
      (sensor.fov_horizontal_deg >= 2.0 * kCameraLimit_deg || steepest >= kCameraLimit_deg))
    found.push_back("sensor '" + sensor.name +
                    "': a depth camera sees less than 170 degrees, less than 85 to each side");
  if (sensor.gain_resolution_deg > sensor.fov_horizontal_deg)
    found.push_back(named(sensor, "gain_resolution_deg", sensor.gain_resolution_deg) +
                    " is wider than fov_horizontal_deg = " + toText(sensor.fov_horizontal_deg) +
                    ": set it to " + toText(sensor.fov_horizontal_deg) + " or less");
}

}  // namespace

VerticalField verticalField(const SensorModel& sensor) {
  if (sensor.fov_lower_deg != 0.0 || sensor.fov_upper_deg != 0.0)
    return {sensor.fov_lower_deg, sensor.fov_upper_deg};
  if (sensor.fov_vertical_deg > 0.0)
    return {-0.5 * sensor.fov_vertical_deg, 0.5 * sensor.fov_vertical_deg};
  return {};
}

double gainRange(const SensorModel& sensor) {
  return sensor.gain_range_m > 0.0 ? sensor.gain_range_m : sensor.range_max_m;
}

double lookVolume(const SensorModel& sensor) {
  const VerticalField field = verticalField(sensor);
  const double row_deg =
      sensor.gain_row_angle_deg > 0.0 ? sensor.gain_row_angle_deg : sensor.gain_resolution_deg;
  const double height_deg = std::max(field.width(), row_deg);
  const double half = 0.5 * height_deg * kDegree;
  const double band = 2.0 * std::cos(field.middle() * kDegree) * std::sin(half);
  return sensor.fov_horizontal_deg * kDegree * band * std::pow(gainRange(sensor), 3) / 3.0;
}

bool seesAllAround(const SensorModel& sensor) {
  constexpr double kGap_deg = 1.0;  // what is not seen matters to nobody
  constexpr double kVertical = 1e-9;
  if (sensor.fov_horizontal_deg < 360.0 - kGap_deg) return false;
  const Eigen::Vector3d axis = T_base_sensor(sensor).linear().col(2);
  const double tilt_deg = std::atan2(axis.head<2>().norm(), std::fabs(axis.z())) / kDegree;
  if (tilt_deg < kVertical) return true;
  const VerticalField field = verticalField(sensor);
  return tilt_deg <= std::min(field.upper_deg, -field.lower_deg) + kGap_deg;
}

SensorModel resolved(SensorModel sensor, double map_range_m) {
  const VerticalField field = verticalField(sensor);
  sensor.fov_lower_deg = field.lower_deg;
  sensor.fov_upper_deg = field.upper_deg;
  sensor.fov_vertical_deg = field.width();
  if (sensor.gain_range_m <= 0.0) sensor.gain_range_m = std::min(sensor.range_max_m, map_range_m);
  if (sensor.gain_row_angle_deg <= 0.0) sensor.gain_row_angle_deg = sensor.gain_resolution_deg;
  return sensor;
}

bool ScanThinning::takes(double stamp_s) {
  constexpr double kRounding_s = 1e-6;  // of stamps
  const bool is_early =
      last_s_ && stamp_s >= *last_s_ && stamp_s < *last_s_ + period_s_ - kRounding_s;
  if (!is_early) last_s_ = stamp_s;
  return !is_early;
}

SensorKind kindOf(const SensorModel& sensor) {
  return sensor.kind == "depth_camera" ? SensorKind::kDepthCamera : SensorKind::kLidar;
}

double denseRange(const SensorModel& sensor, double gap_m) {
  if (sensor.rows < 2) return gainRange(sensor);
  const double row_angle = verticalField(sensor).width() * kDegree / (sensor.rows - 1);
  return std::min(gainRange(sensor), gap_m / std::tan(std::min(row_angle, 0.25 * M_PI)));
}

std::vector<std::string> SensorModel::problems() const {
  std::vector<std::string> found;
  if (kind != "lidar" && kind != "depth_camera")
    found.push_back("sensor '" + name + "': kind '" + kind + "' must be lidar or depth_camera");
  addFieldProblems(*this, found);
  if (range_min_m >= range_max_m)
    found.push_back(named(*this, "range_min_m", range_min_m) + " must be below range_max_m = " +
                    toText(range_max_m) + ", or the sensor sees nothing");
  return found;
}

Eigen::Isometry3d T_base_sensor(const SensorModel& sensor) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(sensor.mount_m);
  transform.rotate(Eigen::AngleAxisd(sensor.mount_yaw_deg * kDegree, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(sensor.mount_pitch_deg * kDegree, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(sensor.mount_roll_deg * kDegree, Eigen::Vector3d::UnitX()));
  return transform;
}

std::vector<Eigen::Vector3f> rayDirections(const SensorModel& sensor) {
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(static_cast<std::size_t>(sensor.rows) * static_cast<std::size_t>(sensor.columns));
  for (int row = 0; row < sensor.rows; ++row)
    for (int column = 0; column < sensor.columns; ++column)
      rays.push_back(kindOf(sensor) == SensorKind::kLidar ? lidarRay(sensor, row, column)
                                                          : pixelRay(sensor, row, column));
  return rays;
}

}  // namespace spelunk
