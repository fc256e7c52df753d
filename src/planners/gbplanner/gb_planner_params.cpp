#include "spelunk/planners/gbplanner/gb_planner_params.h"

#include "spelunk/planners/shared/robot_fit.h"

namespace spelunk::planners::gbplanner {

GbPlannerParams GbPlannerParams::resolvedFor(const RobotModel& robot) const {
  GbPlannerParams resolved = *this;
  resolved.gain_threshold_m3 = passableThreshold(gain_threshold_m3, kPathShare, robot);
  resolved.frontier_gain_m3 = passableThreshold(frontier_gain_m3, kPlaceShare, robot);
  sayLowered("gbplanner.gain_threshold_m3", gain_threshold_m3, resolved.gain_threshold_m3, robot);
  sayLowered("gbplanner.frontier_gain_m3", frontier_gain_m3, resolved.frontier_gain_m3, robot);
  return resolved;
}

std::vector<std::string> GbPlannerParams::problems() const {
  std::vector<std::string> problems;
  if (edge_length_min_m >= edge_length_max_m)
    problems.push_back("edge_length_min_m = " + toText(edge_length_min_m) +
                       " must be less than edge_length_max_m = " + toText(edge_length_max_m));
  if (connection_radius_m < edge_length_min_m)
    problems.push_back("connection_radius_m = " + toText(connection_radius_m) +
                       " must be at least edge_length_min_m = " + toText(edge_length_min_m));
  if (prune_length_m > edge_length_max_m)
    problems.push_back("prune_length_m = " + toText(prune_length_m) +
                       " must not exceed edge_length_max_m = " + toText(edge_length_max_m));
  return problems;
}

std::vector<std::string> GbPlannerParams::problemsFor(const RobotModel& robot,
                                                      double resolution_m) const {
  Problems problems = edgeProblems("edge_length_max_m", edge_length_max_m, resolution_m);
  if ((local_box_m.array() < robot.box_m.array()).any())
    problems.push_back("local_box_m = " + toText(local_box_m) +
                       " does not hold the robot, robot.box_m = " + toText(robot.box_m) +
                       ": make the local box larger on each side");
  return joined(problems, sightProblems("visited_radius_m", visited_radius_m, robot));
}

}  // namespace spelunk::planners::gbplanner
