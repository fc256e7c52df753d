#include "template_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kUpright = 1e-9;                              // of a unit vector
constexpr std::size_t kMaxTiltedSteps = std::size_t{1} << 22;  // 80 MB of lists
constexpr int kMinHeadings = 24;  // the nearest is no farther than a row and a half of a LiDAR

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
      R_base_sensor_(T_base_sensor(sensor).linear()),
      field_middle_(verticalField(sensor).middle() * kDegree),
      fov_vertical_(verticalField(sensor).width() * kDegree),
      is_upright_(R_base_sensor_.col(2).head<2>().norm() < kUpright) {
  const double range_voxels = gainRange(sensor) / resolution_m;
  require(range_voxels > 0.0 && range_voxels < 30000.0,
          "GainEvaluator: gain range does not suit the resolution");
  require(sensor.gain_resolution_deg > 0.0, "GainEvaluator: gain resolution must be positive");
  // Upside down, a column's upper end is its lower one. Its columns may go round the other way, but
  // they lie alike to both sides of the middle one.
  if (is_upright_ && R_base_sensor_(2, 2) < 0.0) field_middle_ = -field_middle_;
  mount_yaw_ = std::atan2(R_base_sensor_(1, 0), R_base_sensor_(0, 0));
  divideField(sensor, 1.0);
  if (is_upright_) {
    addUprightCircle(range_voxels);
  } else {
    makeRoomForHeadings(sensor, range_voxels);
    addTiltedHeadings(range_voxels);
  }
  measureHeight(resolution_m);
}

/// Rows and columns at the sensor's angles between rays, times a factor.
void TemplateRays::divideField(const SensorModel& sensor, double angle_factor) {
  const double row_angle =
      sensor.gain_row_angle_deg > 0.0 ? sensor.gain_row_angle_deg : sensor.gain_resolution_deg;
  circle_columns_ = std::max(1, roundedRatio(360.0, angle_factor * sensor.gain_resolution_deg));
  spacing_ = 2.0 * M_PI / circle_columns_;
  const bool is_circle = sensor.fov_horizontal_deg >= 360.0;
  const int columns_in_fov = roundedRatio(sensor.fov_horizontal_deg * kDegree, spacing_) + 1;
  columns_ = is_circle ? circle_columns_ : std::min(circle_columns_, columns_in_fov);
  rows_ = roundedRatio(verticalField(sensor).width(), angle_factor * row_angle) + 1;
}

/// A tilted sensor has rays of its own at each heading. Where too many steps would be kept for
/// headings that are near enough to each other, the angle between rays grows: a sensor on its side
/// that is taken for one that looks elsewhere errs by more.
void TemplateRays::makeRoomForHeadings(const SensorModel& sensor, double range_voxels) {
  const auto headingsWithin = [&] {
    const double steps_a_heading = 1.5 * range_voxels * columns_ * rows_;
    return static_cast<int>(kMaxTiltedSteps / steps_a_heading);
  };
  constexpr double kCoarser = 1.1;
  for (double factor = kCoarser;
       headingsWithin() < std::min(kMinHeadings, circle_columns_) && rows_ * columns_ > 1;
       factor *= kCoarser)
    divideField(sensor, factor);
  headings_ = std::clamp(headingsWithin(), 1, circle_columns_);
}

/// The field of several rows goes from its lower to its upper limit.
double TemplateRays::elevationOf(int row) const {
  if (rows_ == 1) return field_middle_;
  return field_middle_ + fov_vertical_ * (static_cast<double>(row) / (rows_ - 1) - 0.5);
}

double TemplateRays::solidAngleOf(int row) const {
  const double height = rows_ == 1 ? spacing_ : fov_vertical_ / (rows_ - 1);
  return spacing_ * height * std::cos(elevationOf(row));
}

void TemplateRays::addUprightCircle(double range_voxels) {
  for (int column = 0; column < circle_columns_; ++column)
    for (int row = 0; row < rows_; ++row)
      addRay(direction(column * spacing_, elevationOf(row)), solidAngleOf(row), range_voxels);
}

void TemplateRays::addTiltedHeadings(double range_voxels) {
  for (int heading = 0; heading < headings_; ++heading) {
    const Eigen::Matrix3d R_world_sensor =
        Eigen::AngleAxisd(2.0 * M_PI * heading / headings_, Eigen::Vector3d::UnitZ()) *
        R_base_sensor_;
    for (int column = 0; column < columns_; ++column)
      for (int row = 0; row < rows_; ++row)
        addRay(R_world_sensor *
                   direction((column - 0.5 * (columns_ - 1)) * spacing_, elevationOf(row)),
               solidAngleOf(row), range_voxels);
  }
}

void TemplateRays::measureHeight(double resolution_m) {
  int highest = 0;
  int lowest = 0;
  for (const Ray& ray : rays_) {
    highest = std::max<int>(highest, ray.last[2]);
    lowest = std::min<int>(lowest, ray.last[2]);
  }
  reach_up_m_ = highest * resolution_m;
  reach_down_m_ = -lowest * resolution_m;
}

TemplateRays::Heading TemplateRays::headingAt(double yaw) const {
  if (!is_upright_) {
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
