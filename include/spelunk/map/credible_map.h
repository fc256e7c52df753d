#pragma once

#include <memory>

#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// What makes unknown space worth looking into.
struct Credibility {
  double closing_height_m = 1.4;  ///< At most 30 voxels count.
  double growth_m = 0.2;          ///< At most 7 voxels count.
};

/// The map as gains should see it. A LiDAR of a few rows leaves unknown slivers everywhere: gaps
/// between its rows on far walls, wedges above far floors, holes between the returns. Rays cast
/// through them into rock promise volume that nobody can ever see, and a robot that believes
/// them paces. Three steps on a copy:
/// 1. Gaps of a column between two known or silent voxels up to `closing_height_m` become free
///    beside a free voxel, silent between two silent ones, else occupied.
/// 2. Occupied voxels grow by `growth_m` in x and y and by one voxel in z, which shuts the holes
///    between the returns and leaves open what a robot could enter.
/// 3. Silent voxels (FrozenMap::isSilent), grown as rock is, become occupied where they are
///    unknown: rays end there and they make no frontier.
/// Differs from the paper, which counts every unknown voxel on a ray (Dang 2020, section 4.1).
/// The result is for gains only and says nothing about collisions.
class CredibleMap {
 public:
  explicit CredibleMap(const Credibility& credibility);
  ~CredibleMap();
  CredibleMap(CredibleMap&&) noexcept;
  CredibleMap& operator=(CredibleMap&&) noexcept;

  /// The credible copy of `map`. Only the neighbourhood of what differs from the map of the last
  /// call is computed.
  std::shared_ptr<const FrozenMap> of(std::shared_ptr<const FrozenMap> map);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
