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

/// The start a program is told by "x,y,z,yaw" (the mesh file's frame), if it is told one. Throws
/// OutsideError.
[[nodiscard]] std::optional<Pose> startIn(const std::string& text);

/// The start a program is told, else the world's own, in the frame of the mesh. Throws
/// OutsideError.
[[nodiscard]] Pose startOf(const std::string& text, const std::string& world,
                           const sim::WorldMesh& mesh);

/// In which frame a world is held for a robot that starts there with so much time.
[[nodiscard]] sim::Surroundings surroundingsOf(const std::string& start, const RobotModel& robot,
                                               const map::MapParams& map, double time_limit_s);

}  // namespace spelunk::evaluation
