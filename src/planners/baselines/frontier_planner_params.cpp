#include "spelunk/planners/baselines/frontier_planner_params.h"

#include "spelunk/planners/shared/robot_fit.h"

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

FrontierPlannerParams FrontierPlannerParams::resolvedFor(const RobotModel& robot) const {
  FrontierPlannerParams resolved = *this;
  if (resolved.range_m <= 0.0) resolved.range_m = denseRange(robot);
  return resolved;
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

std::vector<std::string> FrontierPlannerParams::problemsFor(const RobotModel& robot,
                                                            double resolution_m) const {
  const FrontierPlannerParams all = resolvedFor(robot);
  return joined(edgeProblems("range_m", all.range_m, resolution_m),
                sightProblems("range_m", all.range_m, robot));
}

}  // namespace spelunk::planners::baselines
