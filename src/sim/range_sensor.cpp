#include "spelunk/sim/range_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spelunk::sim {
namespace {

/// Draws by counter: ray i of scan n always gets the same ones, whatever happened to other rays.
std::uint64_t hashed(std::uint64_t key, std::uint64_t counter) {
  std::uint64_t z = key + counter * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Nearly normal, mean 0, variance 1, at most 3.5: the sum of four 16-bit uniforms.
float normalFrom(std::uint64_t bits) {
  const auto sum = static_cast<std::int64_t>((bits & 0xFFFF) + ((bits >> 16) & 0xFFFF) +
                                             ((bits >> 32) & 0xFFFF) + (bits >> 48));
  constexpr double kScale = 1.7320508075688772 / 65536.0;  // variance 4 / 12 becomes 1
  return static_cast<float>(static_cast<double>(sum - 131070) * kScale);
}

float uniformFrom(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1.0p-24F; }

/// How far each ray (sensor frame) gets to the hoop; infinite where it passes above or below it.
std::vector<float> rangesToHoop(const std::vector<Eigen::Vector3f>& directions,
                                const Eigen::Isometry3d& T_base_sensor, double radius_m) {
  constexpr double kHalfHeight_m = 0.05;
  const Eigen::Vector2d start = T_base_sensor.translation().head<2>();
  std::vector<float> ranges;
  ranges.reserve(directions.size());
  for (const Eigen::Vector3f& direction : directions) {
    const Eigen::Vector3d ray = T_base_sensor.linear() * direction.cast<double>();
    const double a = ray.head<2>().squaredNorm();
    const double b = start.dot(ray.head<2>());
    const double root = b * b - a * (start.squaredNorm() - radius_m * radius_m);
    const double range = a > 0.0 && root >= 0.0 ? (std::sqrt(root) - b) / a : -1.0;
    const bool meets = range > 0.0 && std::abs(range * ray.z()) <= kHalfHeight_m;
    ranges.push_back(meets ? static_cast<float>(range) : std::numeric_limits<float>::infinity());
  }
  return ranges;
}

}  // namespace

RangeSensor::RangeSensor(const SensorModel& model, double dust_returns, const Rng& rng,
                         double hoop_radius_m)
    : model_(model),
      dust_returns_(dust_returns),
      key_(rng.fork(model.name).next()),
      T_base_sensor_(T_base_sensor(model)),
      directions_(std::make_shared<const std::vector<Eigen::Vector3f>>(rayDirections(model))) {
  if (hoop_radius_m > 0.0) hoop_ranges_ = rangesToHoop(*directions_, T_base_sensor_, hoop_radius_m);
}

double RangeSensor::nextScanTime() const {
  return static_cast<double>(scans_taken_) / model_.rate_hz;
}

std::optional<SimulatedScan> RangeSensor::scan(const MeshScene& scene,
                                               const Eigen::Isometry3d& T_world_base_true,
                                               const Eigen::Isometry3d& T_world_base_odometry,
                                               double stamp_s, const WorldEvents& events) {
  ++scans_taken_;
  if (thinning_ && !thinning_->takes(stamp_s)) return std::nullopt;
  SimulatedScan result;
  result.T_world_sensor_true = T_world_base_true * T_base_sensor_;
  result.directions = directions_;
  result.range_max_m = static_cast<float>(model_.range_max_m);
  const Eigen::Matrix3f turn = result.T_world_sensor_true.linear().cast<float>();
  world_directions_.resize(directions_->size());
  for (std::size_t k = 0; k < directions_->size(); ++k)
    world_directions_[k].noalias() = turn * (*directions_)[k];
  scene.castFan(result.T_world_sensor_true.translation().cast<float>(), world_directions_,
                result.range_max_m, result.true_ranges);
  events.shorten(result.T_world_sensor_true.translation().cast<float>(), world_directions_,
                 result.true_ranges);
  for (std::size_t k = 0; k < hoop_ranges_.size(); ++k)
    result.true_ranges[k] = std::min(result.true_ranges[k], hoop_ranges_[k]);
  result.scan.stamp_s = stamp_s;
  result.scan.sensor = model_.name;
  result.scan.T_world_sensor = T_world_base_odometry * T_base_sensor_;
  result.scan.points = disturbedPoints(result.true_ranges, hashed(key_, scans_taken_));
  return result;
}

std::vector<Eigen::Vector3f> RangeSensor::disturbedPoints(const std::vector<float>& ranges,
                                                          std::uint64_t scan_key) const {
  const auto range_min = static_cast<float>(model_.range_min_m);
  const auto range_max = static_cast<float>(model_.range_max_m);
  const auto noise = static_cast<float>(model_.range_noise_stddev_m);
  const auto dropout = static_cast<float>(model_.dropout_probability);
  const auto dust = static_cast<float>(dust_returns_);
  std::vector<Eigen::Vector3f> points;
  points.reserve(ranges.size());
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    float range = ranges[k];
    bool is_return = range < range_max;
    if (dust > 0.0F && uniformFrom(hashed(scan_key, 4 * k + 1)) < dust) {
      range = range_min + (range - range_min) * uniformFrom(hashed(scan_key, 4 * k + 2));
      is_return = true;
    }
    if (dropout > 0.0F && uniformFrom(hashed(scan_key, 4 * k + 3)) < dropout) continue;
    if (!is_return && model_.reports_misses) points.emplace_back(range_max * (*directions_)[k]);
    if (!is_return) continue;
    if (noise > 0.0F) range += noise * normalFrom(hashed(scan_key, 4 * k));
    if (range >= range_min && range < range_max) points.emplace_back(range * (*directions_)[k]);
  }
  return points;
}

}  // namespace spelunk::sim
