#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "spelunk/common/robot_model.h"
#include "spelunk/terrain/ground_projection.h"

namespace spelunk::terrain {

/// Whether a walking robot finds ground under its way in the occupancy map (Dang 2020,
/// section 4.3).
enum class Footing {
  kGood,      ///< Ground all along, or unknown ground, which is presumed traversable.
  kTooSteep,  ///< Too much rise for the length, or a step.
  kNone       ///< A hole: free space where the ground should be, or no ground within reach.
};

/// Poses here are what planners work with: centres of the robot's box, which a standing robot
/// carries `height_m` above the ground.
struct GroundRules {
  double height_m = 0.5;
  double slope_max_rad = 0.38;
  double step_max_m = 0.2;
  double voxel_m = 0.15;  ///< Of the map: what its heights may be off.

  [[nodiscard]] static GroundRules of(const RobotModel& robot, double voxel_m);
};

/// Looks straight down in some map: groundBelow() of it.
using GroundLookup = std::function<GroundBelow(const Eigen::Vector3d&, double)>;

/// The lookup in a map, which it refers to.
template <class Map>
[[nodiscard]] GroundLookup lookupIn(const Map& map) {
  return [&map](const Eigen::Vector3d& point, double distance_m) {
    return groundBelow(map, point, distance_m);
  };
}

/// `point` at the robot's height above the ground below it; where that is unknown, at the height of
/// `from`, or lower where free space was seen below that: a slope down whose ground is hidden. None
/// if there is none.
[[nodiscard]] std::optional<Eigen::Vector3d> placedOnGround(const Eigen::Vector3d& point,
                                                            const Eigen::Vector3d& from,
                                                            const GroundRules& rules,
                                                            const GroundLookup& ground);

/// The footing of the straight way from a to b, both ends included.
[[nodiscard]] Footing footingAlong(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const GroundRules& rules, const GroundLookup& ground);

}  // namespace spelunk::terrain
