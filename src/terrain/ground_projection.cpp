#include "spelunk/terrain/ground_projection.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::terrain {
namespace {

constexpr double kRounding_m = 1e-9;

template <class Map>
GroundBelow search(const Map& map, const Eigen::Vector3d& point, double distance_m) {
  require(point.allFinite(), "groundBelow: point is not finite");
  require(std::isfinite(distance_m) && distance_m >= 0.0, "groundBelow: impossible distance");
  map::VoxelIndex voxel = map.indexOf(point);
  if (map.at(voxel) == map::Occupancy::kOccupied) return {GroundSearch::kInOccupied, point.z()};
  for (double z = point.z();; --voxel.z()) {
    const map::Occupancy occupancy = map.at(voxel);
    const double top = (voxel.z() + 1) * map.resolution();
    if (occupancy == map::Occupancy::kUnknown) return {GroundSearch::kUnknown, z};
    if (occupancy == map::Occupancy::kOccupied) return {GroundSearch::kFound, top};
    z = std::min(z, top - map.resolution());
    if (z < point.z() - distance_m - kRounding_m) return {GroundSearch::kTooFar, z};
  }
}

}  // namespace

GroundBelow groundBelow(const map::FrozenMap& map, const Eigen::Vector3d& point,
                        double distance_m) {
  return search(map, point, distance_m);
}

GroundBelow groundBelow(const map::LocalWindow& window, const Eigen::Vector3d& point,
                        double distance_m) {
  return search(window, point, distance_m);
}

double inclination(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double along = d.head<2>().norm();
  return along == 0.0 && d.z() == 0.0 ? 0.0 : std::atan2(d.z(), along);
}

}  // namespace spelunk::terrain
