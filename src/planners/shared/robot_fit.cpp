#include "spelunk/planners/shared/robot_fit.h"

#include <algorithm>

#include "spelunk/common/log.h"

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

double passableThreshold(double threshold_m3, double share, const RobotModel& robot) {
  if (robot.sensor_models.empty()) return threshold_m3;
  return std::min(threshold_m3, share * lookVolume(robot));
}

void sayLowered(const std::string& name, double given_m3, double taken_m3,
                const RobotModel& robot) {
  if (taken_m3 >= given_m3) return;
  log(LogLevel::kWarn, name + " = " + toText(given_m3) + " is too much for the sensors of robot '" +
                           robot.name + "', whose best look shows " + toText(lookVolume(robot)) +
                           " m3 (range and field of view): " + toText(taken_m3) +
                           " m3 is taken. Set it to less if too little is explored");
}

Problems joined(Problems all, const Problems& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace spelunk::planners
