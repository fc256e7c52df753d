#pragma once

#include <Eigen/Core>
#include <vector>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners::gbplanner {

/// The direction the robot has been exploring in: the displacement between the pose and the mean of
/// where it was during the last `window_s` seconds, unit length and level. From the velocity if the
/// trail says nothing, else from the heading.
[[nodiscard]] Eigen::Vector3d exploringDirection(const PlanRequest& request, double window_s);

/// S(sigma_i, sigma_exp) of Dang 2020, eq. (1): DTW distance between the path and the straight line
/// of the same length along `direction` (unit), both sampled every `spacing_m`, times the spacing,
/// so that it does not depend on how finely paths are sampled. Square metres.
[[nodiscard]] double dissimilarity(const graph::Polyline& path, const Eigen::Vector3d& direction,
                                   double spacing_m);

enum class PathGainCounting {
  kSum,        ///< As in the paper: summed over the path's vertices.
  kBestVertex  ///< The best weighted vertex alone: nothing is counted twice.
};

/// The sum of Dang 2020, eq. (1): gains at the vertices weighted by exp(-gamma_D * distance along
/// the path). `gains` has one entry a vertex of `path`; m3.
[[nodiscard]] double discountedGain(const graph::Polyline& path, const std::vector<double>& gains,
                                    double distance_weight, PathGainCounting counting);

/// exp(-gamma_S * S), the other factor of eq. (1).
[[nodiscard]] double similarityFactor(double dissimilarity_m2, double similarity_weight);

/// ETA of a path `length_m` long, seconds; `factor` >= 1 pays for corners and turns.
[[nodiscard]] double estimatedTime(double length_m, double speed_mps, double factor);

/// Eq. (3): T = RET - (ETA(cur, frontier) + ETA(frontier, home)), seconds; negative if the robot
/// would not come home.
[[nodiscard]] double explorationTime(double remaining_s, double eta_to_frontier_s,
                                     double eta_frontier_home_s);

/// The part of a frontier's gain that is worth going there for, m3: all of it from the gain of a
/// worthy path on, less than in proportion below. Differs from the paper, which counts all: small
/// gains are mostly slivers that are seen at once or never, while large ones open galleries.
[[nodiscard]] double believedGain(double gain_m3, double gain_threshold_m3);

/// Eq. (2): T * VolumetricGain * exp(-epsilon_D * D); 0 if T is not positive.
[[nodiscard]] double globalExplorationGain(double exploration_time_s, double gain_m3,
                                           double distance_m, double distance_weight);

}  // namespace spelunk::planners::gbplanner
