#pragma once

#include <string>
#include <vector>

#include "spelunk/map/openings.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// Openings as remaining targets: place, size, and that nothing returns from there.
[[nodiscard]] std::vector<planners::RemainingTarget> targetsOf(
    const std::vector<map::Opening>& openings);

/// How many there are, to be added to why a mission ended: "; 1 opening to the outside". Empty if
/// there is none.
[[nodiscard]] std::string countText(const std::vector<map::Opening>& openings);

}  // namespace spelunk::mission
