#include "spelunk/common/robot_model.h"

#include <algorithm>

#include "spelunk/common/self_filter.h"

namespace spelunk {

double longestRange(const RobotModel& robot) {
  double range = 0.0;
  for (const SensorModel& sensor : robot.sensor_models) range = std::max(range, sensor.range_max_m);
  return range;
}

bool seesAllAround(const RobotModel& robot) {
  constexpr double kFullCircle_deg = 359.0;
  return std::any_of(
      robot.sensor_models.begin(), robot.sensor_models.end(),
      [](const SensorModel& sensor) { return sensor.fov_horizontal_deg >= kFullCircle_deg; });
}

RobotKind kindOf(const RobotModel& robot) {
  return robot.kind == "legged" ? RobotKind::kLegged : RobotKind::kAerial;
}

std::vector<std::string> RobotModel::problems() const {
  std::vector<std::string> found;
  if (kind != "aerial" && kind != "legged")
    found.push_back("robot '" + name + "': kind '" + kind + "' must be aerial or legged");
  if (sensors.empty()) found.push_back("robot '" + name + "': needs at least one sensor");
  (void)selfFilterBoxes(*this, &found);
  return found;
}

MotionLimits limitsOf(const RobotModel& robot) {
  return {robot.speed_max_mps, robot.acceleration_max_mps2, robot.yaw_rate_max_radps,
          robot.yaw_acceleration_max_radps2};
}

double brakingDistance(const RobotModel& robot, double speed_mps) {
  return speed_mps * robot.reaction_time_s +
         0.5 * speed_mps * speed_mps / robot.braking_deceleration_mps2;
}

RobotModel loadRobot(ParamTree& tree, const std::string& name, const std::string& config_dir) {
  RobotModel robot;
  robot.name = name;
  tree.read("robot", robot);
  for (const std::string& problem : robot.problems()) tree.addProblem(problem);
  for (const std::string& sensor_name : robot.sensors) {
    SensorModel sensor;
    sensor.name = sensor_name;
    ParamTree file;
    file.addYamlFile(config_dir + "/sensors/" + sensor_name + ".yaml");
    file.read("sensor." + sensor_name, sensor);
    file.requireClean();
    tree.read("sensor." + sensor_name, sensor);
    for (const std::string& problem : sensor.problems()) tree.addProblem(problem);
    robot.sensor_models.push_back(sensor);
  }
  return robot;
}

}  // namespace spelunk
