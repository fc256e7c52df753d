#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace spelunk::graph {

/// Points of a path in order, world frame.
using Polyline = std::vector<Eigen::Vector3d>;

[[nodiscard]] double lengthOf(const Polyline& line);

/// The same line by points exactly `spacing_m` apart along it, from its first point on, and its
/// last point. Throws Precondition if the line is empty or the spacing not positive.
[[nodiscard]] Polyline resampled(const Polyline& line, double spacing_m);

/// Dynamic time warping (Bachrach, Trajectory bundle estimation for perception-driven planning,
/// 2013, as used by Dang 2020, section 4.1): the smallest sum of Euclidean distances over all
/// monotone pairings of the two sequences that begin with both first and end with both last points.
/// Metres, summed over pairs: it grows with the number of points. Neither may be empty.
[[nodiscard]] double dtwDistance(const Polyline& a, const Polyline& b);

/// Groups of similar paths. `members` are indices into the input.
struct PathCluster {
  std::size_t principal = 0;  ///< The longest member.
  std::vector<std::size_t> members;
};

/// DoClustering of Dang 2020, Alg. 4: from the longest path to the shortest, a path joins the first
/// cluster to whose principal it is similar, else it founds one. Similar: DTW distance to the part
/// of the principal that is as long as the path, both at `spacing_m`, divided by the number of
/// points, is at most `mean_distance_max_m`. So a path that runs along a longer one belongs to it.
/// Empty paths are not allowed. Clusters come longest principal first.
[[nodiscard]] std::vector<PathCluster> clusterPaths(const std::vector<Polyline>& paths,
                                                    double spacing_m, double mean_distance_max_m);

}  // namespace spelunk::graph
