#include "template_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr std::size_t kMaxPitchedSteps = std::size_t{1} << 22;  // 40 MB of lists

int roundedRatio(double a, double b) { return static_cast<int>(std::lround(a / b)); }

double rounded(double component) {
  constexpr double kScale = 1 << 24;
  return std::round(component * kScale) / kScale;
}

int wrapped(long index, int count) {
  const long rest = index % count;
  return static_cast<int>(rest < 0 ? rest + count : rest);
}

Eigen::Vector3d direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace

TemplateRays::TemplateRays(const SensorModel& sensor, double resolution_m)
    : mount_m_(sensor.mount_m),
      mount_yaw_(sensor.mount_yaw_deg * kDegree),
      fov_vertical_(sensor.fov_vertical_deg * kDegree),
      is_level_(sensor.mount_pitch_deg == 0.0) {
  const double range_voxels = sensor.gain_range_m / resolution_m;
  require(range_voxels > 0.0 && range_voxels < 30000.0,
          "GainEvaluator: gain range does not suit the resolution");
  require(sensor.gain_resolution_deg > 0.0, "GainEvaluator: gain resolution must be positive");
  circle_columns_ = std::max(1, roundedRatio(360.0, sensor.gain_resolution_deg));
  spacing_ = 2.0 * M_PI / circle_columns_;
  const bool is_circle = sensor.fov_horizontal_deg >= 360.0;
  const int columns_in_fov = roundedRatio(sensor.fov_horizontal_deg * kDegree, spacing_) + 1;
  columns_ = is_circle ? circle_columns_ : std::min(circle_columns_, columns_in_fov);
  const double row_angle =
      sensor.gain_row_angle_deg > 0.0 ? sensor.gain_row_angle_deg : sensor.gain_resolution_deg;
  rows_ = roundedRatio(sensor.fov_vertical_deg, row_angle) + 1;
  if (is_level_)
    addLevelCircle(range_voxels);
  else
    addPitchedHeadings(sensor, range_voxels);
}

double TemplateRays::elevationOf(int row) const {
  return rows_ == 1 ? 0.0 : fov_vertical_ * (static_cast<double>(row) / (rows_ - 1) - 0.5);
}

double TemplateRays::solidAngleOf(int row) const {
  const double height = rows_ == 1 ? spacing_ : fov_vertical_ / (rows_ - 1);
  return spacing_ * height * std::cos(elevationOf(row));
}

void TemplateRays::addLevelCircle(double range_voxels) {
  for (int column = 0; column < circle_columns_; ++column)
    for (int row = 0; row < rows_; ++row)
      addRay(direction(column * spacing_, elevationOf(row)), solidAngleOf(row), range_voxels);
}

void TemplateRays::addPitchedHeadings(const SensorModel& sensor, double range_voxels) {
  const double steps_a_heading = 1.5 * range_voxels * columns_ * rows_;
  headings_ = std::clamp(static_cast<int>(kMaxPitchedSteps / steps_a_heading), 1, circle_columns_);
  const Eigen::Matrix3d R_base_sensor = T_base_sensor(sensor).linear();
  for (int heading = 0; heading < headings_; ++heading) {
    const Eigen::Matrix3d R_world_sensor =
        Eigen::AngleAxisd(2.0 * M_PI * heading / headings_, Eigen::Vector3d::UnitZ()) *
        R_base_sensor;
    for (int column = 0; column < columns_; ++column)
      for (int row = 0; row < rows_; ++row)
        addRay(R_world_sensor *
                   direction((column - 0.5 * (columns_ - 1)) * spacing_, elevationOf(row)),
               solidAngleOf(row), range_voxels);
  }
}

TemplateRays::Heading TemplateRays::headingAt(double yaw) const {
  if (!is_level_) {
    const auto count = static_cast<std::size_t>(columns_ * rows_);
    const long nearest = std::lround(yaw / (2.0 * M_PI) * headings_);
    return {static_cast<std::size_t>(wrapped(nearest, headings_)) * count, count};
  }
  if (columns_ == circle_columns_) return {0, rays_.size()};
  const double first = (yaw + mount_yaw_) / spacing_ - 0.5 * (columns_ - 1);
  return {static_cast<std::size_t>(wrapped(std::lround(first), circle_columns_) * rows_),
          static_cast<std::size_t>(columns_ * rows_)};
}

void TemplateRays::addRay(const Eigen::Vector3d& direction, double solid_angle,
                          double range_voxels) {
  const auto volumeWithin = [solid_angle](double length) {
    return static_cast<float>(solid_angle * length * length * length / 3.0);
  };
  std::array<double, 3> next;
  std::array<double, 3> spacing;
  std::array<int, 3> sign;
  for (std::size_t i = 0; i < 3; ++i) {
    const double component = rounded(direction(static_cast<int>(i)));
    sign[i] = component < 0.0 ? -1 : 1;
    spacing[i] =
        component == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::fabs(component);
    next[i] = 0.5 * spacing[i];
  }
  Step step{};
  const auto begin = static_cast<std::uint32_t>(steps_.size());
  const auto cone = static_cast<std::uint32_t>(cone_volumes_.size());
  for (;;) {
    std::size_t axis = next[0] <= next[1] ? 0 : 1;
    if (next[2] < next[axis]) axis = 2;
    const double length = std::min(next[axis], range_voxels);
    cone_volumes_.push_back(volumeWithin(length));
    cone_lengths_.push_back(static_cast<float>(length));
    if (!(next[axis] < range_voxels)) break;
    next[axis] += spacing[axis];
    step[axis] = static_cast<std::int16_t>(step[axis] + sign[axis]);
    steps_.push_back(step);
  }
  rays_.push_back({begin, static_cast<std::uint32_t>(steps_.size()), step, {}, cone});
  addCrossings(rays_.back());
}

void TemplateRays::addCrossings(Ray& ray) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ray.crossings[axis] = static_cast<std::uint32_t>(crossings_.size());
    int offset = 0;
    for (std::uint32_t i = ray.begin; i < ray.end; ++i) {
      if (steps_[i][axis] == offset) continue;
      offset = steps_[i][axis];
      crossings_.push_back(static_cast<std::uint16_t>(i - ray.begin));
    }
  }
}

}  // namespace spelunk::map
