#include "spelunk/terrain/ground_rules.h"

#include <algorithm>
#include <cmath>

namespace spelunk::terrain {
namespace {

constexpr double kSpacing_m = 0.3;  // between the places looked at; no hole that matters is smaller
constexpr double kSearchDepth_m = 3.0;  // below a sample: from the roof of a drift to its floor

/// How far the ground may be from where the straight line expects it.
double toleranceOf(const GroundRules& rules) { return rules.step_max_m + rules.voxel_m; }

Footing footingAt(const Eigen::Vector3d& point, const GroundRules& rules,
                  const GroundLookup& ground) {
  const double tolerance = toleranceOf(rules);
  const double expected = point.z() - rules.height_m;
  const GroundBelow below = ground(point, rules.height_m + tolerance);
  switch (below.status) {
    case GroundSearch::kFound:
      return std::fabs(below.z - expected) <= tolerance ? Footing::kGood : Footing::kTooSteep;
    case GroundSearch::kUnknown:
      return below.z < expected - tolerance ? Footing::kNone : Footing::kGood;
    case GroundSearch::kInOccupied:
      return Footing::kTooSteep;
    case GroundSearch::kTooFar:
      return Footing::kNone;
  }
  return Footing::kNone;
}

}  // namespace

GroundRules GroundRules::of(const RobotModel& robot, double voxel_m) {
  GroundRules rules;
  rules.height_m = robot.ride_height_m + robot.box_lift_m;
  rules.slope_max_rad = robot.slope_max_deg * M_PI / 180.0;
  rules.step_max_m = robot.step_max_m;
  rules.voxel_m = voxel_m;
  return rules;
}

std::optional<Eigen::Vector3d> placedOnGround(const Eigen::Vector3d& point,
                                              const Eigen::Vector3d& from, const GroundRules& rules,
                                              const GroundLookup& ground) {
  const GroundBelow below = ground(point, kSearchDepth_m);
  if (below.status == GroundSearch::kFound)
    return Eigen::Vector3d(point.x(), point.y(), below.z + rules.height_m);
  if (below.status == GroundSearch::kUnknown)  // it cannot lie where free space was seen
    return Eigen::Vector3d(point.x(), point.y(), std::min(from.z(), below.z + rules.height_m));
  return std::nullopt;
}

Footing footingAlong(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const GroundRules& rules,
                     const GroundLookup& ground) {
  const double level = (b - a).head<2>().norm();
  if (std::fabs(b.z() - a.z()) > std::tan(rules.slope_max_rad) * level + toleranceOf(rules))
    return Footing::kTooSteep;
  const int steps = std::max(1, static_cast<int>(std::ceil(level / kSpacing_m)));
  for (int i = 0; i <= steps; ++i) {
    const Footing footing =
        footingAt(a + (b - a) * (static_cast<double>(i) / steps), rules, ground);
    if (footing != Footing::kGood) return footing;
  }
  return Footing::kGood;
}

}  // namespace spelunk::terrain
