#pragma once

#include <visualization_msgs/Marker.h>

#include <string>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::bridge {

/// The world as a triangle list, lighter the higher.
[[nodiscard]] visualization_msgs::Marker meshMarker(const sim::WorldMesh& mesh,
                                                    const std::string& frame);

}  // namespace spelunk::bridge
