#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "spelunk/planners/shared/free_space.h"
#include "spelunk/planners/shared/known_space.h"

namespace spelunk::planners {

/// Finds the nearest place to a point where the robot's box may be, on a grid around it.
class PlaceFinder {
 public:
  /// Looks up to `reach_m` away, in steps of `step_m`.
  PlaceFinder(double reach_m, double step_m);

  /// The point itself if the box is free there. Equally near places: the first in the grid's order.
  [[nodiscard]] std::optional<Eigen::Vector3d> find(const Eigen::Vector3d& point,
                                                    const FreeSpace& space) const;

  /// The nearest place that also keeps the safe distance; where there is none, the nearest free
  /// one.
  [[nodiscard]] std::optional<Eigen::Vector3d> findRoomy(const Eigen::Vector3d& point,
                                                         const KnownSpace& space) const;

 private:
  std::vector<Eigen::Vector3d> offsets_;  // nearest first
};

}  // namespace spelunk::planners
