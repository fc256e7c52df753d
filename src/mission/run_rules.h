#pragma once

#include <string>
#include <vector>

#include "spelunk/mission/run_config.h"

namespace spelunk::mission {

/// What map.range_max_m is if it follows from the sensors, metres: as far as the farthest of them
/// sees, and a voxel less than any that reports misses, for a miss lies at its full range.
[[nodiscard]] double mapRangeFor(const RunConfig& config);

/// Where values of different sections contradict each other: one sentence each that names both,
/// their numbers and the remedy. Expects values that follow from others to be written out.
[[nodiscard]] std::vector<std::string> problemsBetween(const RunConfig& config);

}  // namespace spelunk::mission
