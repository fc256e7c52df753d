#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// Which voxels a box may touch.
enum class Passable {
  kKnownFree,   ///< Unknown space is an obstacle.
  kNotOccupied  ///< Unknown space may be entered: for plans that reach beyond what was seen.
};

/// The configuration space of an axis-aligned box in the whole map. Obstacles and unknown space are
/// inflated by the box chunk by chunk, where a query falls; then every box check is one bit. Chunks
/// are kept, and a later map only renews those that changed. A box is free only if every voxel it
/// touches is known free; the answers equal those of looking at each of these voxels (Dang 2020,
/// section 4.1, bounding box D_R). With Passable::kNotOccupied "free" reads
/// "not occupied"; beyond OctoMap's key range nothing passes. Not thread-safe.
class ConfigurationSpace {
 public:
  /// `box_size`: full extents, metres. Throws Precondition unless they are positive and finite.
  explicit ConfigurationSpace(const Eigen::Vector3d& box_size,
                              Passable passable = Passable::kKnownFree);
  ConfigurationSpace(const Eigen::Vector3d& box_size, std::shared_ptr<const FrozenMap> map,
                     Passable passable = Passable::kKnownFree);
  ~ConfigurationSpace();
  ConfigurationSpace(ConfigurationSpace&&) noexcept;
  ConfigurationSpace& operator=(ConfigurationSpace&&) noexcept;

  /// From now on answers are about `map`; it must come before the first query.
  void use(std::shared_ptr<const FrozenMap> map);

  /// kFree, or why not: kOccupied if any touched voxel is occupied, else kUnknown.
  [[nodiscard]] Occupancy boxAt(const Eigen::Vector3d& centre);
  [[nodiscard]] bool isFree(const Eigen::Vector3d& centre);

  /// The box moved straight from `a` to `b`: kFree only if no voxel the sweep touches is occupied
  /// or unknown; else why it is refused first. Never unsafe; checked at steps of at most one voxel.
  [[nodiscard]] Occupancy sweep(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  [[nodiscard]] bool isSweepFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

  [[nodiscard]] const Eigen::Vector3d& boxSize() const;
  [[nodiscard]] Passable passable() const;
  [[nodiscard]] double resolution() const;  ///< Of the map in use, metres.
  /// Chunks inflated so far: what queries have cost.
  [[nodiscard]] std::size_t inflations() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
