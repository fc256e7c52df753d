#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/pose.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// Numbers between commas; none if there is anything else or too few or too many of them.
[[nodiscard]] std::optional<std::vector<double>> numbersIn(const std::string& text,
                                                           std::size_t count);

/// Why a text is no finite number; empty if it is one. For options that only have a range: not a
/// number lies in every range.
[[nodiscard]] std::string whyNotFinite(const std::string& text);

/// The start a program is told by "x,y,z,yaw" (world frame), if it is told one. Throws
/// OutsideError.
[[nodiscard]] std::optional<Pose> startIn(const std::string& text);

/// The start a program is told, else the world's own, in the frame of the mesh. Throws
/// OutsideError, which proposes a place with room for a robot of `robot_m` if neither says one.
[[nodiscard]] Pose startOf(const std::string& text, const sim::WorldMesh& mesh,
                           const Eigen::Vector3d& robot_m);

/// In which frame a world is held for a robot that starts there with so much time.
[[nodiscard]] sim::Surroundings surroundingsOf(const std::string& start, const RobotModel& robot,
                                               const map::MapParams& map, double time_limit_s);

}  // namespace spelunk::evaluation
