#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "spelunk/map/presumed_ways.h"

namespace spelunk::planners {

/// How far along a way presumed ways are looked for, metres.
inline constexpr double kPresumedReach_m = 300.0;

/// A piece of a presumed way that brings the robot nearer by less is no progress, metres.
inline constexpr double kPresumedProgress_m = 3.0;

/// Where a presumed way is to be closed if no piece of it can be flown: just ahead of its start.
[[nodiscard]] std::optional<map::ClosedPlace> placeAhead(const std::vector<Eigen::Vector3d>& way);

}  // namespace spelunk::planners
