#include "spelunk/sim/winding.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "spelunk/sim/rock_noise.h"

namespace spelunk::sim {

Passage windingPassage(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                       const Winding& winding, Rng& rng) {
  const std::uint64_t seed = rng.next();
  const Eigen::Vector3d axis = to - from;
  const double length = std::sqrt(axis.squaredNorm());
  const int count = std::max(2, static_cast<int>(std::ceil(length / winding.station_pitch_m)));
  const double run = std::max(std::sqrt(axis.head<2>().squaredNorm()), 1e-9);
  const Eigen::Vector3d side(-axis.y() / run, axis.x() / run, 0.0);
  Passage passage;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    const double arc = t * length;
    const double taper = std::min(1.0, 5.0 * std::min(t, 1.0 - t));
    const double swing = 2.0 * rockNoise(arc, 13.0, seed) - 1.0;
    const auto between = [&](double low, double high, std::uint64_t stream) {
      return low + (high - low) * rockNoise(arc, 11.0, seed + stream);
    };
    passage.stations.push_back({from + t * axis + taper * winding.wander_m * swing * side,
                                between(winding.width_min_m, winding.width_max_m, 1),
                                between(winding.height_min_m, winding.height_max_m, 2)});
  }
  return passage;
}

Relief::Relief(double relief_m, double wavelength_m, const Eigen::Vector2d& zero,
               std::uint64_t seed)
    : relief_m_(relief_m), wavelength_m_(wavelength_m), seed_(seed) {
  offset_ = raw(zero.x(), zero.y());
}

double Relief::raw(double x, double y) const {
  return relief_m_ * rockNoise(Eigen::Vector3d(x, y, 0.0), wavelength_m_, seed_);
}

Eigen::Vector3d Relief::lift(double x, double y) const { return {x, y, raw(x, y) - offset_}; }

void Relief::lift(Passage& passage) const {
  for (Station& station : passage.stations)
    station.floor = lift(station.floor.x(), station.floor.y());
}

Edges thinned(const Edges& edges, int nodes, double extra_share, Rng& rng) {
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(rng.below(static_cast<int>(i)))]);

  std::vector<int> root(static_cast<std::size_t>(nodes));
  std::iota(root.begin(), root.end(), 0);
  const auto rootOf = [&](int node) {
    while (root[static_cast<std::size_t>(node)] != node)
      node = root[static_cast<std::size_t>(node)];
    return node;
  };
  std::vector<char> kept(edges.size(), 0);
  for (const std::size_t i : order) {
    const int a = rootOf(edges[i].first);
    const int b = rootOf(edges[i].second);
    kept[i] = static_cast<char>(a != b || rng.uniform() < extra_share);
    root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  Edges chosen;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (kept[i] != 0) chosen.push_back(edges[i]);
  return chosen;
}

}  // namespace spelunk::sim
