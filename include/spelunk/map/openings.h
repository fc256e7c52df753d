#pragma once

#include <vector>

#include "spelunk/map/frozen_map.h"

namespace spelunk::map {

/// Where known free space borders on silent voxels (FrozenMap::isSilent): a portal, a hole to the
/// surface, or rock that no ray comes back from.
struct Opening {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< In the plane of the border's outer rim.
  Eigen::Vector3d outward = Eigen::Vector3d::UnitX();  ///< Unit vector out of the free space.
  double area_m2 = 0.0;                                ///< Of the border as seen along `outward`.
};

/// All openings, the largest first, that `box` (full extents) could pass through: smaller ones are
/// no way for this robot. Parts with less than the half of the box between them are one opening.
[[nodiscard]] std::vector<Opening> findOpenings(const FrozenMap& map, const Eigen::Vector3d& box);

}  // namespace spelunk::map
