#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// A place through which no way leads, whatever the map says; metres.
struct ClosedPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Shortest ways from one place through what was seen to be open. A LiDAR of a few rows sees far
/// down a gallery, but no robot's box fits between its rows, so that a gallery seen from both ends
/// is no way in a map whose unknown space is an obstacle. Here any cell of 4 x 4 x 4 voxels that is
/// known free by a quarter is passable, and ways go from cell to cell (26 neighbours, Dijkstra).
/// They are guesses: only what is flown piece by piece through known free space makes them ways.
class PresumedWays {
 public:
  /// `map`: gaps between the rows should be closed (see CredibleMap). Looks `reach_m` far along
  /// the ways at most.
  PresumedWays(std::shared_ptr<const FrozenMap> map, const Eigen::Vector3d& from, double reach_m,
               const std::vector<ClosedPlace>& closed = {});
  ~PresumedWays();
  PresumedWays(PresumedWays&&) noexcept;
  PresumedWays& operator=(PresumedWays&&) noexcept;

  /// Along the way, metres; infinity if none of the cells at or beside the point was reached.
  [[nodiscard]] double distanceTo(const Eigen::Vector3d& point) const;

  /// Centres of the cells from `from` to the cell nearest to the point; empty if not reached.
  [[nodiscard]] std::vector<Eigen::Vector3d> wayTo(const Eigen::Vector3d& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
