#pragma once

#include <string>

#include "spelunk/sim/world_mesh.h"
#include "spelunk/sim/world_plan.h"

namespace spelunk::sim {

/// Changes whenever the same description gives another mesh; part of a cache's key.
inline constexpr int kWorldGeneratorVersion = 2;

/// The mesh of a description (worlds/<name>.yaml): closed, every edge shared by exactly two
/// triangles, normals towards the free space, one connected free space around the start; the same
/// bits on every machine. Throws OutsideError if the description is missing or wrong, or if its
/// start does not leave 0.6 m around the robot.
[[nodiscard]] WorldMesh generateWorld(const std::string& description_path);

/// The same for a plan at hand.
[[nodiscard]] WorldMesh meshOf(const WorldPlan& plan);

}  // namespace spelunk::sim
