#include "spelunk/navigation/rounded_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::navigation {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSamePlace_m = 1e-6;
constexpr double kStraight_rad = 1e-4;
constexpr double kCusp_rad = 150.0 * kPi / 180.0;  // sharper turns are no faster by an arc
constexpr double kStraightenShare = 0.3;           // of the tolerance; the arcs have the rest

double distanceToSegment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d way = b - a;
  const double square = way.squaredNorm();
  if (square <= 0.0) return (point - a).norm();
  const double share = std::clamp((point - a).dot(way) / square, 0.0, 1.0);
  return (a + share * way - point).norm();
}

/// Which waypoints stay (Douglas and Peucker, "Algorithms for the reduction of the number of points
/// required to represent a digitized line", Cartographica 1973).
std::vector<char> keptWaypoints(const Path& path, double tolerance_m) {
  std::vector<char> kept(path.size(), 0);
  kept.front() = kept.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, path.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double largest = tolerance_m;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double gap =
          distanceToSegment(path[i].position, path[first].position, path[last].position);
      if (gap > largest) {
        largest = gap;
        farthest = i;
      }
    }
    if (farthest == first) continue;
    kept[farthest] = 1;
    open.push_back({first, farthest});
    open.push_back({farthest, last});
  }
  return kept;
}

/// A corner between two straight pieces, rounded by an arc that touches both.
struct Corner {
  double cut_m = 0.0;  ///< From the corner to where the arc begins and ends.
  double radius_m = 0.0;
  double turn_rad = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< From the arc's begin to its centre.
  bool is_cusp = false;
};

Corner cornerAt(const Eigen::Vector3d& before, const Eigen::Vector3d& corner,
                const Eigen::Vector3d& after, double tolerance_m) {
  const Eigen::Vector3d in = (corner - before).normalized();
  const Eigen::Vector3d out = (after - corner).normalized();
  const Eigen::Vector3d across = out - in.dot(out) * in;
  Corner found;
  found.turn_rad = std::atan2(across.norm(), in.dot(out));
  if (found.turn_rad < kStraight_rad) return found;
  found.is_cusp = found.turn_rad > kCusp_rad;
  if (found.is_cusp) return found;
  const double room = 0.5 * std::min((corner - before).norm(), (after - corner).norm());
  found.cut_m = std::min(room, tolerance_m / std::tan(0.25 * found.turn_rad));
  found.radius_m = found.cut_m / std::tan(0.5 * found.turn_rad);
  found.normal = across.normalized();
  return found;
}

class CurveBuilder {
 public:
  CurveBuilder(const std::vector<Eigen::Vector3d>& corners, double step_m) : step_m_(step_m) {
    constexpr std::size_t kExtra = 8;  // samples at a corner and where pieces are rounded up
    double length = 0.0;
    for (std::size_t i = 1; i < corners.size(); ++i) length += (corners[i] - corners[i - 1]).norm();
    samples_.reserve(static_cast<std::size_t>(length / step_m) + kExtra * corners.size());
  }

  void line(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const double length = (b - a).norm();
    if (length < kSamePlace_m) return;
    const Eigen::Vector3d tangent = (b - a) / length;
    const int steps = std::max(2, stepsOf(length));  // a standstill at both ends needs a middle
    append({arc_m_, a, tangent, Eigen::Vector3d::Zero(), false});
    for (int k = 1; k <= steps; ++k) {
      const double along = length * k / steps;
      append({arc_m_ + along, a + along * tangent, tangent, Eigen::Vector3d::Zero(), false});
    }
    arc_m_ += length;
  }

  void arc(const Eigen::Vector3d& begin, const Eigen::Vector3d& tangent, const Corner& corner) {
    const double length = corner.radius_m * corner.turn_rad;
    const int steps = std::max(4, stepsOf(length));
    const Eigen::Vector3d centre = begin + corner.radius_m * corner.normal;
    for (int k = 0; k <= steps; ++k) {
      const double angle = corner.turn_rad * k / steps;
      const Eigen::Vector3d inward = std::cos(angle) * corner.normal - std::sin(angle) * tangent;
      append({arc_m_ + length * k / steps, centre - corner.radius_m * inward,
              std::cos(angle) * tangent + std::sin(angle) * corner.normal, inward / corner.radius_m,
              false});
    }
    arc_m_ += length;
  }

  void cusp() {
    if (!samples_.empty()) samples_.back().is_cusp = true;
  }

  std::vector<CurveSample> take() { return std::move(samples_); }

 private:
  [[nodiscard]] int stepsOf(double length_m) const {
    return std::max(1, static_cast<int>(std::ceil(length_m / step_m_)));
  }

  /// Where two pieces meet, the sharper curvature counts.
  void append(const CurveSample& sample) {
    if (samples_.empty() || sample.arc_m - samples_.back().arc_m > 1e-9) {
      samples_.push_back(sample);
    } else if (sample.curvature.squaredNorm() > samples_.back().curvature.squaredNorm()) {
      samples_.back().curvature = sample.curvature;
    }
  }

  double step_m_;
  double arc_m_ = 0.0;
  std::vector<CurveSample> samples_;
};

}  // namespace

std::vector<Eigen::Vector3d> straightened(const Path& path, double tolerance_m) {
  require(!path.empty(), "straightened: empty path");
  const std::vector<char> kept = keptWaypoints(path, tolerance_m);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!kept[i]) continue;
    if (points.empty() || (path[i].position - points.back()).norm() > kSamePlace_m)
      points.push_back(path[i].position);
  }
  return points;
}

std::vector<CurveSample> roundedCurve(const Path& path, double tolerance_m, double step_m) {
  require(tolerance_m > 0.0 && step_m > 0.0, "roundedCurve: tolerance and step must be positive");
  const std::vector<Eigen::Vector3d> points = straightened(path, kStraightenShare * tolerance_m);
  if (points.size() < 2) return {{0.0, points.front()}};
  CurveBuilder curve(points, step_m);
  Eigen::Vector3d from = points.front();
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Corner corner =
        cornerAt(points[i - 1], points[i], points[i + 1], (1.0 - kStraightenShare) * tolerance_m);
    const Eigen::Vector3d in = (points[i] - points[i - 1]).normalized();
    const Eigen::Vector3d out = (points[i + 1] - points[i]).normalized();
    const Eigen::Vector3d begin = points[i] - corner.cut_m * in;
    curve.line(from, begin);
    if (corner.cut_m > 0.0) curve.arc(begin, in, corner);
    if (corner.is_cusp) curve.cusp();
    from = points[i] + corner.cut_m * out;
  }
  curve.line(from, points.back());
  return curve.take();
}

}  // namespace spelunk::navigation
