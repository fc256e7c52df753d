#include "spelunk/planners/baselines/frontier_planner_params.h"

namespace spelunk::planners::baselines {

navigation::NavigationParams FrontierPlannerParams::navigation() const {
  navigation::NavigationParams ways;
  ways.method = way_method;
  ways.safe_distance_m = safe_distance_m;
  ways.iterations = iterations;
  return ways;
}

std::vector<std::string> FrontierPlannerParams::problems() const { return navigation().problems(); }

FrontierPlannerParams FrontierPlannerParams::withRrtStar() {
  FrontierPlannerParams params;
  params.way_method = "rrt_star";
  params.iterations = 2500;  // all of them are used, and each way there and home is one query
  params.candidates = 3;
  return params;
}

}  // namespace spelunk::planners::baselines
