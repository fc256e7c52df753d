#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "spelunk/mission/way_home_search.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::mission {

/// The planner's next path, and its way home from the path's end.
struct ExplorationJob {
  planners::PlanRequest request;
};

/// The planner's way home from here.
struct WayHomeJob {
  planners::PlanRequest request;
};

/// Navigation's way to a point.
struct PointJob {
  navigation::NavigationParams params;
  navigation::NavigationQuery query;
};

/// A plan to be computed, on data that nobody changes: run it in any thread, or at once.
/// WayHomeSearch is the way home by navigation, which the planner is not asked for.
struct PlanJob {
  std::uint64_t number = 0;
  std::vector<planners::PathReport> reports;  ///< For the planner, before anything is asked of it.
  std::variant<ExplorationJob, WayHomeJob, WayHomeSearch, PointJob> work;
};

/// What a job brought: the plan, and the way home from its end (or from the start if there is
/// none); or navigation's answer.
struct PlanOutcome {
  std::uint64_t number = 0;
  planners::PlanResult plan;
  planners::PlanResult home;
  navigation::NavigationAnswer go_to;
};

[[nodiscard]] PlanOutcome run(const PlanJob& job, planners::ExplorationPlanner& planner);
[[nodiscard]] bool isExploration(const PlanJob& job);

}  // namespace spelunk::mission
