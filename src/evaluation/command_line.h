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

/// Why a text is no finite number; empty if it is one. For options that only have a range: not a
/// number lies in every range.
[[nodiscard]] std::string whyNotFinite(const std::string& text);

/// The start a program is told by "x,y,z,yaw", else the world's own. Throws OutsideError, which
/// proposes a place with room for a robot of `robot_m` if neither says one.
[[nodiscard]] Pose startOf(const std::string& text, const sim::WorldMesh& mesh,
                           const Eigen::Vector3d& robot_m);

}  // namespace spelunk::evaluation
