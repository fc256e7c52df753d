#pragma once

#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners {

/// Adds a refused sample to its counter of the stats.
void count(Rejection rejection, PlanStats& stats);

}  // namespace spelunk::planners
