#include "spelunk/planners/gbplanner/exploration_gain.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::planners::gbplanner {
namespace {

constexpr double kNoDirection =
    1e-3;  // metres or metres a second below which a vector says nothing

Eigen::Vector3d level(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), 0.0}; }

}  // namespace

Eigen::Vector3d exploringDirection(const PlanRequest& request, double window_s) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  for (const StampedPose& stamped : request.trail) {
    if (stamped.time_s < request.time_s - window_s) continue;
    mean += stamped.pose.position;
    ++count;
  }
  if (count > 0) {
    const Eigen::Vector3d moved = level(request.pose.position - mean / count);
    constexpr double kStandstill = 0.5;  // metres: less is hovering, not exploring
    if (moved.norm() > kStandstill) return moved.normalized();
  }
  const Eigen::Vector3d velocity = level(request.velocity);
  if (velocity.norm() > kNoDirection) return velocity.normalized();
  return {std::cos(request.pose.yaw), std::sin(request.pose.yaw), 0.0};
}

double dissimilarity(const graph::Polyline& path, const Eigen::Vector3d& direction,
                     double spacing_m) {
  const graph::Polyline sampled = graph::resampled(path, spacing_m);
  const graph::Polyline line{path.front(), path.front() + direction * graph::lengthOf(path)};
  return spacing_m * graph::dtwDistance(sampled, graph::resampled(line, spacing_m));
}

double discountedGain(const graph::Polyline& path, const std::vector<double>& gains,
                      double distance_weight, PathGainCounting counting) {
  require(path.size() == gains.size(), "discountedGain: one gain a vertex");
  double sum = 0.0;
  double best = 0.0;
  double distance = 0.0;
  for (std::size_t j = 0; j < path.size(); ++j) {
    if (j > 0) distance += (path[j] - path[j - 1]).norm();
    const double weighted = gains[j] * std::exp(-distance_weight * distance);  // Eq. (1)
    sum += weighted;
    best = std::max(best, weighted);
  }
  return counting == PathGainCounting::kSum ? sum : best;
}

double similarityFactor(double dissimilarity_m2, double similarity_weight) {
  return std::exp(-similarity_weight * dissimilarity_m2);  // Eq. (1)
}

double estimatedTime(double length_m, double speed_mps, double factor) {
  return length_m / speed_mps * factor;
}

double explorationTime(double remaining_s, double eta_to_frontier_s, double eta_frontier_home_s) {
  return remaining_s - (eta_to_frontier_s + eta_frontier_home_s);  // Eq. (3)
}

double believedGain(double gain_m3, double gain_threshold_m3) {
  return gain_m3 < gain_threshold_m3 ? gain_m3 * gain_m3 / gain_threshold_m3 : gain_m3;
}

double globalExplorationGain(double exploration_time_s, double gain_m3, double distance_m,
                             double distance_weight) {
  if (exploration_time_s <= 0.0) return 0.0;
  return exploration_time_s * gain_m3 * std::exp(-distance_weight * distance_m);  // Eq. (2)
}

}  // namespace spelunk::planners::gbplanner
