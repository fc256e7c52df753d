#include "spelunk/planners/baselines/frontier_planner_params.h"

namespace spelunk::planners::baselines {

navigation::NavigationParams FrontierPlannerParams::navigation() const {
  navigation::NavigationParams ways;
  ways.method = way_method;
  ways.safe_distance_m = safe_distance_m;
  ways.iterations = iterations;
  return ways;
}

navigation::NavigationParams FrontierPlannerParams::homeNavigation() const {
  navigation::NavigationParams ways = navigation();
  if (way_method != "rrt_star") return ways;
  ways.method = "adaptive";
  ways.iterations = FrontierPlannerParams().iterations;
  return ways;
}

std::vector<std::string> FrontierPlannerParams::problems() const { return navigation().problems(); }

FrontierPlannerParams FrontierPlannerParams::forNearest() {
  FrontierPlannerParams params;
  params.gain_min_m3 = 0.0;  // every frontier is a target
  return params;
}

FrontierPlannerParams FrontierPlannerParams::forRrtStar() {
  FrontierPlannerParams params;
  params.way_method = "rrt_star";
  params.iterations = 2500;  // all of them are used, and each way there and home is one query
  params.candidates = 3;
  params.gain_min_m3 = 10.0;  // around a LiDAR of few rows, floor and roof are frontier everywhere
  params.range_m = 10.0;
  return params;
}

}  // namespace spelunk::planners::baselines
