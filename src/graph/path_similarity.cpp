#include "spelunk/graph/path_similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

bool isAlong(const Polyline& path, const Polyline& principal, double mean_distance_max_m) {
  const std::size_t count = std::min(path.size(), principal.size());
  const Polyline head(principal.begin(), principal.begin() + static_cast<std::ptrdiff_t>(count));
  return dtwDistance(path, head) <= mean_distance_max_m * static_cast<double>(path.size());
}

}  // namespace

double lengthOf(const Polyline& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

Polyline resampled(const Polyline& line, double spacing_m) {
  require(!line.empty(), "resampled: the line is empty");
  require(spacing_m > 0.0, "resampled: spacing must be positive");
  Polyline points{line.front()};
  double to_next = spacing_m;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector3d step = line[i] - line[i - 1];
    const double length = step.norm();
    double at = to_next;
    for (; at <= length; at += spacing_m) points.push_back(line[i - 1] + step * (at / length));
    to_next = at - length;
  }
  constexpr double kSamePoint = 1e-9;
  if ((points.back() - line.back()).norm() > kSamePoint) points.push_back(line.back());
  return points;
}

double dtwDistance(const Polyline& a, const Polyline& b) {
  require(!a.empty() && !b.empty(), "dtwDistance: a path is empty");
  std::vector<double> previous(b.size(), std::numeric_limits<double>::infinity());
  std::vector<double> current(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      double before = i == 0 && j == 0 ? 0.0 : previous[j];
      if (j > 0) before = std::min({before, current[j - 1], previous[j - 1]});
      current[j] = before + (a[i] - b[j]).norm();
    }
    std::swap(previous, current);
  }
  return previous.back();
}

std::vector<PathCluster> clusterPaths(const std::vector<Polyline>& paths, double spacing_m,
                                      double mean_distance_max_m) {
  std::vector<double> lengths;
  std::vector<Polyline> sampled;
  for (const Polyline& path : paths) {
    lengths.push_back(lengthOf(path));
    sampled.push_back(resampled(path, spacing_m));
  }
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
  std::vector<PathCluster> clusters;
  for (const std::size_t i : order) {
    const auto home = std::find_if(clusters.begin(), clusters.end(), [&](const PathCluster& c) {
      return isAlong(sampled[i], sampled[c.principal], mean_distance_max_m);
    });
    if (home == clusters.end()) {
      clusters.push_back({i, {i}});
    } else {
      home->members.push_back(i);
    }
  }
  return clusters;
}

}  // namespace spelunk::graph
