#pragma once

#include "spelunk/common/path.h"
#include "spelunk/map/configuration_space.h"

namespace spelunk::navigation {

/// The path with waypoints left out wherever the box can go straight past them: from each kept
/// waypoint on to the farthest one within `reach_m` of arc length that a free sweep leads to.
/// Segments of the given path are kept where nothing shorter is free. The path must not be empty.
[[nodiscard]] Path shortened(const Path& path, map::ConfigurationSpace& space, double reach_m);

}  // namespace spelunk::navigation
