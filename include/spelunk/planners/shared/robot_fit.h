#pragma once

#include <string>
#include <vector>

#include "spelunk/common/robot_model.h"

namespace spelunk::planners {

/// Where parameters of a planner contradict the robot or the map it plans for: one sentence each
/// with both names, both numbers and the remedy. `name` is the parameter's, without its section.
using Problems = std::vector<std::string>;

/// A range of rays, or a radius taken for seen, beyond what any of the sensors sees. A robot
/// without sensors contradicts nothing.
[[nodiscard]] Problems sightProblems(const std::string& name, double range_m,
                                     const RobotModel& robot);

/// Edges shorter than a voxel: no two vertices could be told apart.
[[nodiscard]] Problems edgeProblems(const std::string& name, double edge_length_m,
                                    double resolution_m);

/// Appends `more` to `all`.
[[nodiscard]] Problems joined(Problems all, const Problems& more);

}  // namespace spelunk::planners
