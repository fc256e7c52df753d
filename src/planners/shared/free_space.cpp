#include "spelunk/planners/shared/free_space.h"

#include <algorithm>
#include <utility>

namespace spelunk::planners {

std::optional<GroundUnder> groundUnder(const map::FrozenMap& map, const RobotModel& robot) {
  if (kindOf(robot) != RobotKind::kLegged) return std::nullopt;
  return GroundUnder{terrain::GroundRules::of(robot, map.resolution()), terrain::lookupIn(map)};
}

FreeSpace::FreeSpace(Sweep sweep, const Eigen::Vector3d& box_size, const AxisAlignedBox& bounds,
                     const std::vector<NoGoZone>& zones, std::optional<GroundUnder> ground)
    : sweep_(std::move(sweep)),
      box_size_(box_size),
      bounds_(bounds),
      zones_(zones),
      ground_(std::move(ground)) {}

std::optional<Eigen::Vector3d> FreeSpace::placed(const Eigen::Vector3d& point,
                                                 const Eigen::Vector3d& from) const {
  if (!ground_) return point;
  return terrain::placedOnGround(point, from, ground_->rules, ground_->lookup);
}

Rejection FreeSpace::along(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  if (!bounds_.contains(a) || !bounds_.contains(b)) return Rejection::kOutOfBounds;
  const map::Occupancy swept = sweep_(a, b);
  if (swept == map::Occupancy::kOccupied) return Rejection::kOccupied;
  if (swept == map::Occupancy::kUnknown) return Rejection::kUnknown;
  const bool meets_zone = std::any_of(zones_.begin(), zones_.end(), [&](const NoGoZone& zone) {
    return sweptBoxMeets(zone, a, b, box_size_);
  });
  if (meets_zone) return Rejection::kNoGo;
  const bool is_walkable =
      !ground_ ||
      terrain::footingAlong(a, b, ground_->rules, ground_->lookup) == terrain::Footing::kGood;
  return is_walkable ? Rejection::kNone : Rejection::kTooSteep;
}

}  // namespace spelunk::planners
