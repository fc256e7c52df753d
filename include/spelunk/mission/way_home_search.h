#pragma once

#include <vector>

#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// Ways home for navigation to look for when the trail is cut and the planner knows no way round:
/// to home itself, or to a place on the trail that home is still reachable from.
struct WayHomeSearch {
  navigation::NavigationParams params;
  std::vector<navigation::NavigationQuery> queries;  ///< Tried in turn until one has an answer.
};

/// The first way found, kind kHome, from the pose the queries start at to the goal of one of them;
/// else kNoPath with what each query failed by. The same search gives the same way.
[[nodiscard]] planners::PlanResult findWayHome(const WayHomeSearch& search);

}  // namespace spelunk::mission
