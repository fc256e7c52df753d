#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/pose.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// Numbers between commas; none if there is anything else or too few or too many of them.
[[nodiscard]] std::optional<std::vector<double>> numbersIn(const std::string& text,
                                                           std::size_t count);

/// The start a program is told by "x,y,z,yaw", else the world's own. Throws OutsideError.
[[nodiscard]] Pose startOf(const std::string& text, const std::string& world,
                           const sim::WorldMesh& mesh);

}  // namespace spelunk::evaluation
