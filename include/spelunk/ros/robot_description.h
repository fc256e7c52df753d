#pragma once

#include <string>

#include "spelunk/common/robot_model.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::bridge {

/// The body as a URDF with root link `base_link`: a walker's trunk and legs, or an aerial robot's
/// trunk with its rotors, one rigid link.
[[nodiscard]] std::string robotDescription(const RobotModel& robot, const sim::SimParams& params,
                                           const std::string& base_link);

}  // namespace spelunk::bridge
