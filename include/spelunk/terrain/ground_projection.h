#pragma once

#include <Eigen/Core>

#include "spelunk/map/frozen_map.h"
#include "spelunk/map/local_window.h"

namespace spelunk::terrain {

enum class GroundSearch {
  kFound,
  kInOccupied,  ///< The point itself lies in an occupied voxel.
  kUnknown,     ///< An unknown voxel lies between the point and any ground.
  kTooFar       ///< Free as far down as was looked.
};

/// The ground below a point in the occupancy map.
struct GroundBelow {
  GroundSearch status = GroundSearch::kUnknown;
  /// z of the ground: the top of the first occupied voxel. Otherwise the lowest z that is known to
  /// be free (the point's own where nothing is).
  double z = 0.0;
};

/// Looks straight down from `point` through free voxels to the first occupied one, at most
/// `distance_m` from the point to its top. Throws Precondition unless point and distance are finite
/// and the distance is not negative.
[[nodiscard]] GroundBelow groundBelow(const map::FrozenMap& map, const Eigen::Vector3d& point,
                                      double distance_m);
[[nodiscard]] GroundBelow groundBelow(const map::LocalWindow& window, const Eigen::Vector3d& point,
                                      double distance_m);

/// Angle of the line from a to b against the horizontal, rad: positive where b is higher, 0 for
/// points in one place.
[[nodiscard]] double inclination(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace spelunk::terrain
