#pragma once

#include <string>
#include <vector>

#include "spelunk/common/robot_model.h"

namespace spelunk::planners {

/// One sentence for each contradiction, with both names, both numbers and the remedy.
using Problems = std::vector<std::string>;

// Where parameters of a planner contradict the robot or the map it plans for. `name` is the
// parameter's, without its section.

/// A range of rays, or a radius taken for seen, beyond what any of the sensors sees. A robot
/// without sensors contradicts nothing.
[[nodiscard]] Problems sightProblems(const std::string& name, double range_m,
                                     const RobotModel& robot);

/// Edges shorter than a voxel: no two vertices could be told apart.
[[nodiscard]] Problems edgeProblems(const std::string& name, double edge_length_m,
                                    double resolution_m);

/// A threshold of volume that the robot's sensors can pass: no more than `share` of what one look
/// shows, for a higher one would end each mission as explored before it has begun. A robot without
/// sensors keeps it.
[[nodiscard]] double passableThreshold(double threshold_m3, double share, const RobotModel& robot);

/// Shares of a look: half of one is unknown at the border of what was seen, so a path past a border
/// can promise that; a place beside rock sees far less. Lower thresholds than these stay.
inline constexpr double kPathShare = 0.5;
inline constexpr double kPlaceShare = 0.1;

/// Says that a threshold was lowered so; `name` with its section. Silent if it was not.
void sayLowered(const std::string& name, double given_m3, double taken_m3, const RobotModel& robot);

/// Appends `more` to `all`.
[[nodiscard]] Problems joined(Problems all, const Problems& more);

}  // namespace spelunk::planners
