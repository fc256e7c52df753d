#include "spelunk/planners/shared/robot_fit.h"

namespace spelunk::planners {

Problems sightProblems(const std::string& name, double range_m, const RobotModel& robot) {
  constexpr double kRounding_m = 1e-9;
  const double seen_m = longestGainRange(robot);
  if (robot.sensor_models.empty() || range_m <= seen_m + kRounding_m) return {};
  return {name + " = " + toText(range_m) + " is beyond what robot '" + robot.name +
          "' sees: the longest gain_range_m of its sensors is " + toText(seen_m) + "; set " + name +
          " to 0 or to at most that, or let the sensor and the map see farther (range_max_m of "
          "both)"};
}

Problems edgeProblems(const std::string& name, double edge_length_m, double resolution_m) {
  if (edge_length_m >= resolution_m) return {};
  return {name + " = " + toText(edge_length_m) + " is shorter than a voxel, map.resolution_m = " +
          toText(resolution_m) + ": raise it or make the map finer"};
}

Problems joined(Problems all, const Problems& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace spelunk::planners
