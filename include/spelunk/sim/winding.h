#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/sim/world_plan.h"

namespace spelunk::sim {

/// How a passage runs from one point to another.
struct Winding {
  double wander_m = 0.0;  ///< Greatest distance from the straight line.
  double width_min_m = 2.0;
  double width_max_m = 4.0;
  double height_min_m = 3.0;
  double height_max_m = 4.0;
  double station_pitch_m = 4.0;
};

/// A passage between two floor points. Draws one number from `rng`.
[[nodiscard]] Passage windingPassage(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                     const Winding& winding, Rng& rng);

/// A rolling floor of height 0 at `zero`.
class Relief {
 public:
  Relief(double relief_m, double wavelength_m, const Eigen::Vector2d& zero, std::uint64_t seed);
  [[nodiscard]] Eigen::Vector3d lift(double x, double y) const;  ///< (x, y, height of the floor)
  void lift(Passage& passage) const;                             ///< Puts its stations on it.

 private:
  [[nodiscard]] double raw(double x, double y) const;
  double relief_m_;
  double wavelength_m_;
  std::uint64_t seed_;
  double offset_ = 0.0;
};

/// An undirected graph of places by index.
using Edges = std::vector<std::pair<int, int>>;

/// A random choice of `edges` that still joins all `nodes` places that `edges` joins: a random
/// spanning forest and `extra_share` of the others, in the order given.
[[nodiscard]] Edges thinned(const Edges& edges, int nodes, double extra_share, Rng& rng);

}  // namespace spelunk::sim
