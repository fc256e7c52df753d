#pragma once

#include <string>

#include "spelunk/sim/walker_params.h"

namespace spelunk::sim {

/// The robot as a URDF of boxes, cylinders and spheres, from the same numbers the simulator walks
/// on. The root link is `base_link`; joints are named <leg>_HAA, <leg>_HFE and <leg>_KFE as in
/// JointState, the feet's links <leg>_FOOT. Limits of effort and velocity are nominal.
[[nodiscard]] std::string walkerUrdf(const WalkerParams& params, const std::string& base_link);

}  // namespace spelunk::sim
