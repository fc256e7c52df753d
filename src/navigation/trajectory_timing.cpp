#include "spelunk/navigation/trajectory_timing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "spelunk/common/contract.h"
#include "spelunk/navigation/rounded_curve.h"

namespace spelunk::navigation {
namespace {

constexpr double kCurveStep_m = 0.05;
constexpr double kPointPeriod_s = 0.1;
constexpr double kSidewaysShare = 0.8;  // of the acceleration; 0.6 are then left along the curve
constexpr double kDefaultTolerance_m = 0.1;
constexpr double kLeastSlope = 0.2;  // horizontal share of a direction that shows a heading

/// Speed along a curve, one value a sample; acceleration is constant between samples.
struct SpeedProfile {
  std::vector<double> speed_mps;
  std::vector<double> time_s;  ///< From the begin of the curve.
};

/// The curvature between two samples. Where a line meets an arc their common sample has the arc's,
/// so the smaller one holds for the piece between.
const Eigen::Vector3d& curvatureBetween(const CurveSample& a, const CurveSample& b) {
  return a.curvature.squaredNorm() < b.curvature.squaredNorm() ? a.curvature : b.curvature;
}

double accelerationAlong(const CurveSample& a, const CurveSample& b, double speed, double limit) {
  const double sideways = speed * speed * curvatureBetween(a, b).norm();
  return std::sqrt(std::max(0.36 * limit * limit, limit * limit - sideways * sideways));
}

/// Slow pieces by the arc of a curve, which cuts the corners of the path they are given on.
std::vector<SlowPiece> onCurve(std::vector<SlowPiece> slow, const Path& path,
                               const std::vector<CurveSample>& curve) {
  const double length = lengthOf(path);
  const double share = length > 0.0 ? curve.back().arc_m / length : 1.0;
  for (SlowPiece& piece : slow) {
    require(piece.speed_mps > 0.0, "timed: a slow piece has no speed");
    piece.from_m *= share;
    piece.to_m *= share;
  }
  return slow;
}

std::vector<double> speedCaps(const std::vector<CurveSample>& curve, const MotionLimits& limits,
                              const std::vector<SlowPiece>& slow) {
  std::vector<double> caps;
  caps.reserve(curve.size());
  for (const CurveSample& sample : curve) {
    const double bend = sample.curvature.norm();
    const double sideways = kSidewaysShare * limits.acceleration_mps2;
    double cap = limits.speed_mps;
    if (bend * cap * cap > sideways) cap = std::sqrt(sideways / bend);
    for (const SlowPiece& piece : slow)
      if (sample.arc_m >= piece.from_m && sample.arc_m <= piece.to_m)
        cap = std::min(cap, piece.speed_mps);
    caps.push_back(sample.is_cusp ? 0.0 : cap);
  }
  caps.back() = 0.0;
  return caps;
}

/// The speed after the piece from `a` to `b`, or before it, if it is entered at `speed` and all
/// acceleration is used; never less than `speed`, as the root of a square is exact.
double speedBeyond(const CurveSample& a, const CurveSample& b, double speed, double limit) {
  const double along = accelerationAlong(a, b, speed, limit);
  return std::sqrt(speed * speed + 2.0 * along * (b.arc_m - a.arc_m));
}

/// Lowers each speed to what its neighbour allows, backward then forward. One that is not above its
/// neighbour is allowed as it is.
SpeedProfile profileOf(const std::vector<CurveSample>& curve, const MotionLimits& limits,
                       const std::vector<SlowPiece>& slow, double start_speed) {
  SpeedProfile profile{speedCaps(curve, limits, slow), {0.0}};
  profile.time_s.reserve(curve.size());
  std::vector<double>& v = profile.speed_mps;
  const double a = limits.acceleration_mps2;
  for (std::size_t i = curve.size() - 1; i-- > 0;)
    if (v[i] > v[i + 1]) v[i] = std::min(v[i], speedBeyond(curve[i], curve[i + 1], v[i + 1], a));
  v[0] = std::min(v[0], start_speed);
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    if (v[i + 1] > v[i])
      v[i + 1] = std::min(v[i + 1], speedBeyond(curve[i], curve[i + 1], v[i], a));
    const double step = curve[i + 1].arc_m - curve[i].arc_m;
    profile.time_s.push_back(profile.time_s.back() + 2.0 * step / (v[i] + v[i + 1]));
  }
  return profile;
}

/// Fades the part of the start velocity that the curve cannot take up: a cubic that begins at zero
/// offset with velocity `excess` and ends at zero with zero velocity.
struct Blend {
  Eigen::Vector3d excess = Eigen::Vector3d::Zero();
  double duration_s = 0.0;

  void addTo(TrajectoryPoint& point, double t) const {
    if (t >= duration_s) return;
    const double u = t / duration_s;
    point.pose.position += t * (1.0 - u) * (1.0 - u) * excess;
    point.velocity += (1.0 - u) * (1.0 - 3.0 * u) * excess;
    point.acceleration += (6.0 * u - 4.0) / duration_s * excess;
  }
};

Blend blendOf(const Eigen::Vector3d& excess, const MotionLimits& limits) {
  const double size = excess.norm();
  if (size < 1e-6) return {};
  return {excess, std::max(0.2, 4.0 * size / limits.acceleration_mps2)};
}

/// The curve at a time of its profile; `i` is the last sample not later than `t`.
TrajectoryPoint pointAt(const std::vector<CurveSample>& curve, const SpeedProfile& profile,
                        std::size_t i, double t) {
  TrajectoryPoint point;
  if (i + 1 >= curve.size()) {
    point.pose.position = curve.back().position;
    return point;
  }
  const CurveSample& a = curve[i];
  const CurveSample& b = curve[i + 1];
  const double step_s = profile.time_s[i + 1] - profile.time_s[i];
  const double tau = std::min(t - profile.time_s[i], step_s);
  const double along = (profile.speed_mps[i + 1] - profile.speed_mps[i]) / step_s;
  const double speed = profile.speed_mps[i] + along * tau;
  const double length = b.arc_m - a.arc_m;
  const double share =
      std::clamp((profile.speed_mps[i] + 0.5 * along * tau) * tau / length, 0.0, 1.0);
  const Eigen::Vector3d tangent_in = a.is_cusp ? Eigen::Vector3d(b.tangent) : a.tangent;
  const Eigen::Vector3d tangent = (tangent_in + share * (b.tangent - tangent_in)).normalized();
  point.pose.position = a.position + share * (b.position - a.position);
  point.velocity = speed * tangent;
  point.acceleration = along * tangent + speed * speed * curvatureBetween(a, b);
  return point;
}

/// Turns a heading towards a moving aim within rate and acceleration, at rest in the end.
class HeadingFollower {
 public:
  HeadingFollower(const MotionLimits& limits, double yaw, double rate)
      : limits_(limits), yaw_(yaw), rate_(rate) {}

  void advance(double aim, double step_s, double time_left_s) {
    const double gap = wrapAngle(aim - yaw_);
    const double a = limits_.yaw_acceleration_radps2;
    const double size = std::min({limits_.yaw_rate_radps, std::sqrt(1.4 * a * std::abs(gap)),
                                  std::abs(gap) / step_s, a * time_left_s});
    const double wanted = std::copysign(size, gap);
    const double next = rate_ + std::clamp(wanted - rate_, -a * step_s, a * step_s);
    yaw_ = wrapAngle(yaw_ + 0.5 * (rate_ + next) * step_s);
    rate_ = next;
  }
  [[nodiscard]] double yaw() const { return yaw_; }
  [[nodiscard]] double rate() const { return rate_; }

 private:
  MotionLimits limits_;
  double yaw_;
  double rate_;
};

double headingOf(const TrajectoryPoint& point, double fallback) {
  const Eigen::Vector3d& v = point.velocity;
  const double flat = std::hypot(v.x(), v.y());
  if (flat < 0.05 || flat < kLeastSlope * v.norm()) return fallback;
  return std::atan2(v.y(), v.x());
}

void addHeadings(Trajectory& points, const MotionLimits& limits, const Pose& first,
                 double start_rate, std::optional<double> end_aim) {
  HeadingFollower heading(limits, first.yaw, start_rate);
  double aim = end_aim.value_or(first.yaw);
  points.front().pose.yaw = first.yaw;
  points.front().yaw_rate = start_rate;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!end_aim) aim = headingOf(points[i], aim);
    heading.advance(aim, points[i].time_s - points[i - 1].time_s,
                    points.back().time_s - points[i].time_s);
    points[i].pose.yaw = heading.yaw();
    points[i].yaw_rate = heading.rate();
  }
  points.back().yaw_rate = 0.0;
}

/// Time to turn on the spot from rest to rest, with some slack for the follower's steps.
double turnTime(double angle, const MotionLimits& limits) {
  const double size = std::abs(angle);
  if (size < 1e-6) return 0.0;
  const double rate =
      std::min(limits.yaw_rate_radps, std::sqrt(0.7 * limits.yaw_acceleration_radps2 * size));
  return size / rate + 2.0 * rate / limits.yaw_acceleration_radps2 + 0.5;
}

double turnOf(const Path& path) { return wrapAngle(path.back().yaw - path.front().yaw); }

/// Times of the points: every kPointPeriod_s and exactly at the end.
std::vector<double> pointTimes(double duration_s) {
  std::vector<double> times;
  for (int k = 0; k * kPointPeriod_s < duration_s - 0.2 * kPointPeriod_s; ++k)
    times.push_back(k * kPointPeriod_s);
  if (times.empty()) times.push_back(0.0);
  if (duration_s > 0.0) times.push_back(duration_s);
  return times;
}

Trajectory sampled(const std::vector<CurveSample>& curve, const SpeedProfile& profile,
                   const Blend& blend, const MotionStart& start, double duration_s) {
  Trajectory points;
  std::size_t i = 0;
  for (const double t : pointTimes(duration_s)) {
    while (i + 1 < curve.size() && profile.time_s[i + 1] <= t) ++i;
    TrajectoryPoint point = pointAt(curve, profile, i, t);
    blend.addTo(point, t);
    point.time_s = start.time_s + t;
    points.push_back(point);
  }
  if (points.size() > 1) points.back().acceleration.setZero();
  return points;
}

void checkLimits(const MotionLimits& limits) {
  require(limits.speed_mps > 0.0 && limits.acceleration_mps2 > 0.0 && limits.yaw_rate_radps > 0.0 &&
              limits.yaw_acceleration_radps2 > 0.0,
          "timed: limits must be positive");
}

}  // namespace

Trajectory timed(const Path& path, const MotionLimits& limits, const MotionStart& start,
                 double corner_tolerance_m, const std::vector<SlowPiece>& slow) {
  require(!path.empty(), "timed: empty path");
  checkLimits(limits);
  const auto curve = roundedCurve(path, corner_tolerance_m, kCurveStep_m);
  const bool moves = curve.size() > 1;
  const double speed = moves ? std::max(0.0, start.velocity.dot(curve.front().tangent)) : 0.0;
  const SpeedProfile profile = profileOf(curve, limits, onCurve(slow, path, curve), speed);
  const Eigen::Vector3d taken_up =
      moves ? Eigen::Vector3d(profile.speed_mps.front() * curve.front().tangent)
            : Eigen::Vector3d::Zero();
  const Blend blend = blendOf(start.velocity - taken_up, limits);
  const double turn_s = moves ? 0.0 : turnTime(turnOf(path), limits);
  const double duration = std::max({profile.time_s.back(), blend.duration_s, turn_s});
  Trajectory points = sampled(curve, profile, blend, start, duration);
  const auto aim = moves ? std::nullopt : std::optional<double>(path.back().yaw);
  addHeadings(points, limits, path.front(), start.yaw_rate, aim);
  return points;
}

double travelTime(const Path& path, const MotionLimits& limits,
                  const std::vector<SlowPiece>& slow) {
  require(!path.empty(), "travelTime: empty path");
  checkLimits(limits);
  const auto curve = roundedCurve(path, kDefaultTolerance_m, kCurveStep_m);
  if (curve.size() < 2) return turnTime(turnOf(path), limits);
  return profileOf(curve, limits, onCurve(slow, path, curve), 0.0).time_s.back();
}

}  // namespace spelunk::navigation
