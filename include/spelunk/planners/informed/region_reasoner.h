#pragma once

#include "spelunk/common/pose.h"
#include "spelunk/map/frozen_map.h"

namespace spelunk::planners::informed {

/// What kind of place the robot is in.
enum class Region {
  kBranch,  ///< Narrow: obstacles near on the z axis and on the x or the y axis.
  kVoid     ///< Wide.
};

[[nodiscard]] const char* toText(Region region);

/// The region-based reasoner (Akbari 2021, section VII): rays both ways along the axes of the
/// robot's frame; an axis is hit if both its rays meet an occupied voxel within `distance_m`.
/// Unknown voxels stop no ray.
[[nodiscard]] Region regionAt(const map::FrozenMap& map, const Pose& pose, double distance_m);

}  // namespace spelunk::planners::informed
