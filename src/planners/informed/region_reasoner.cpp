#include "spelunk/planners/informed/region_reasoner.h"

#include <cmath>

namespace spelunk::planners::informed {
namespace {

bool hits(const map::FrozenMap& map, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
          double distance_m) {
  const double step = 0.5 * map.resolution();
  for (double along = 0.0; along <= distance_m; along += step)
    if (map.at(Eigen::Vector3d(from + along * direction)) == map::Occupancy::kOccupied) return true;
  return false;
}

}  // namespace

const char* toText(Region region) { return region == Region::kBranch ? "branch" : "void"; }

Region regionAt(const map::FrozenMap& map, const Pose& pose, double distance_m) {
  const auto is_shut_in = [&](const Eigen::Vector3d& axis) {
    return hits(map, pose.position, axis, distance_m) &&
           hits(map, pose.position, -axis, distance_m);
  };
  const Eigen::Vector3d forward(std::cos(pose.yaw), std::sin(pose.yaw), 0.0);
  const Eigen::Vector3d left(-forward.y(), forward.x(), 0.0);
  const bool is_narrow =
      is_shut_in(Eigen::Vector3d::UnitZ()) && (is_shut_in(forward) || is_shut_in(left));
  return is_narrow ? Region::kBranch : Region::kVoid;
}

}  // namespace spelunk::planners::informed
