#pragma once

#include <Eigen/Core>
#include <memory>

#include "spelunk/map/local_window.h"

namespace spelunk::map {

/// Which voxels a box may touch.
enum class Passable {
  kKnownFree,   ///< Unknown space is an obstacle.
  kNotOccupied  ///< Unknown space may be entered: for plans that reach beyond what was seen.
};

/// The configuration space of an axis-aligned box in a window: inflated once a cycle, then every
/// box check is one bit. A box is free only if every voxel it touches is known free; the answers
/// equal those of looking at each of these voxels (Dang 2020, section 4.1, bounding box D_R).
/// With Passable::kNotOccupied "free" below reads "not occupied"; beyond the window nothing passes.
class InflatedWindow {
 public:
  /// `box_size`: full extents, metres.
  InflatedWindow(const LocalWindow& window, const Eigen::Vector3d& box_size,
                 Passable passable = Passable::kKnownFree);
  ~InflatedWindow();
  InflatedWindow(InflatedWindow&&) noexcept;

  /// kFree, or why not: kOccupied if any touched voxel is occupied, else kUnknown (also for boxes
  /// that leave the window).
  [[nodiscard]] Occupancy boxAt(const Eigen::Vector3d& centre) const;
  [[nodiscard]] bool isFree(const Eigen::Vector3d& centre) const;

  /// The box moved straight from `a` to `b`: kFree only if no voxel the sweep touches is occupied
  /// or unknown. Never unsafe; checked at steps of at most one voxel.
  [[nodiscard]] Occupancy sweep(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] bool isSweepFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  [[nodiscard]] const Eigen::Vector3d& boxSize() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
