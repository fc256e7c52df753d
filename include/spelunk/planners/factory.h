#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners {

/// The planners that explore. makePlanner() knows one more, "oracle", which flies a given tour.
[[nodiscard]] std::vector<std::string> plannerNames();

/// The parameters of planner `name` as `tree` sets them, for tables; those that follow from the
/// robot have the value they take for it. Throws as makePlanner() does.
[[nodiscard]] std::vector<ParamDescription> describePlanner(const std::string& name,
                                                            ParamTree& tree,
                                                            const RobotModel& robot);

/// The planner `name` for this robot, its parameters read from section `name` of `tree` (problems
/// are added to the tree). Throws OutsideError that lists the known names if there is none such.
[[nodiscard]] std::unique_ptr<ExplorationPlanner> makePlanner(const std::string& name,
                                                              ParamTree& tree,
                                                              const RobotModel& robot,
                                                              double resolution_m);

}  // namespace spelunk::planners
