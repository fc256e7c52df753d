#include "spelunk/common/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace spelunk {
namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Vector3f lidarRay(const SensorModel& sensor, int row, int column) {
  const double vertical = sensor.fov_vertical_deg * kDegree;
  const double horizontal = sensor.fov_horizontal_deg * kDegree;
  const double elevation =
      sensor.rows == 1 ? 0.0 : -0.5 * vertical + vertical * row / (sensor.rows - 1);
  const bool is_full_circle = sensor.fov_horizontal_deg >= 360.0;
  const int gaps = is_full_circle ? sensor.columns : std::max(1, sensor.columns - 1);
  const double azimuth = -0.5 * horizontal + horizontal * column / gaps;
  return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
      .cast<float>();
}

Eigen::Vector3f pixelRay(const SensorModel& sensor, int row, int column) {
  const double half_width = std::tan(0.5 * sensor.fov_horizontal_deg * kDegree);
  const double half_height = std::tan(0.5 * sensor.fov_vertical_deg * kDegree);
  const double left = half_width * (1.0 - 2.0 * (column + 0.5) / sensor.columns);
  const double up = half_height * (2.0 * (row + 0.5) / sensor.rows - 1.0);
  return Eigen::Vector3d(1.0, left, up).normalized().cast<float>();
}

}  // namespace

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
  if (sensor.rows < 2) return sensor.gain_range_m;
  const double row_angle = sensor.fov_vertical_deg * kDegree / (sensor.rows - 1);
  return std::min(sensor.gain_range_m, gap_m / std::tan(std::min(row_angle, 0.25 * M_PI)));
}

std::vector<std::string> SensorModel::problems() const {
  std::vector<std::string> found;
  if (kind != "lidar" && kind != "depth_camera")
    found.push_back("sensor '" + name + "': kind '" + kind + "' must be lidar or depth_camera");
  if (kind == "depth_camera" && (fov_horizontal_deg >= 170.0 || fov_vertical_deg >= 170.0))
    found.push_back("sensor '" + name + "': a depth camera sees less than 170 degrees");
  if (range_min_m >= range_max_m)
    found.push_back("sensor '" + name + "': range_min_m must be below range_max_m");
  return found;
}

Eigen::Isometry3d T_base_sensor(const SensorModel& sensor) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(sensor.mount_m);
  transform.rotate(Eigen::AngleAxisd(sensor.mount_yaw_deg * kDegree, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(sensor.mount_pitch_deg * kDegree, Eigen::Vector3d::UnitY()));
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
