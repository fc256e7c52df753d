#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/map/frozen_map.h"
#include "spelunk/map/occupancy.h"
#include "spelunk/terrain/ground_rules.h"

namespace spelunk::planners {

/// Why the robot's box may not be at a place.
enum class Rejection { kNone, kOccupied, kUnknown, kOutOfBounds, kNoGo, kTooSteep };

/// The ground a robot with legs depends on.
struct GroundUnder {
  terrain::GroundRules rules;
  terrain::GroundLookup lookup;
};

/// The ground of a map for a robot with legs, none for one that flies. Refers to the map.
[[nodiscard]] std::optional<GroundUnder> groundUnder(const map::FrozenMap& map,
                                                     const RobotModel& robot);

/// Where the robot's box may go: known free space inside the bounds and outside all zones; for a
/// robot with legs, above ground it can walk on. A view for the duration of one plan: what it
/// refers to must outlive it.
class FreeSpace {
 public:
  /// Status of the box moved straight between two points.
  using Sweep = std::function<map::Occupancy(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

  FreeSpace(Sweep sweep, const Eigen::Vector3d& box_size, const AxisAlignedBox& bounds,
            const std::vector<NoGoZone>& zones, std::optional<GroundUnder> ground = std::nullopt);

  [[nodiscard]] Rejection at(const Eigen::Vector3d& point) const { return along(point, point); }
  [[nodiscard]] Rejection along(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] bool isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return along(a, b) == Rejection::kNone;
  }

  /// Where a robot that comes from `from` would be at `point`: for one with legs at its height
  /// above the ground there. None if there is no ground.
  [[nodiscard]] std::optional<Eigen::Vector3d> placed(const Eigen::Vector3d& point,
                                                      const Eigen::Vector3d& from) const;

 private:
  Sweep sweep_;
  Eigen::Vector3d box_size_;
  const AxisAlignedBox& bounds_;
  const std::vector<NoGoZone>& zones_;
  std::optional<GroundUnder> ground_;
};

}  // namespace spelunk::planners
