#include "spelunk/common/robot_model.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "spelunk/common/file_lookup.h"
#include "spelunk/common/self_filter.h"

namespace spelunk {
namespace {

namespace fs = std::filesystem;

std::string sensorFile(const std::string& sensor, const std::string& config_dir,
                       const std::vector<std::string>& folders) {
  if (looksLikePath(sensor)) return existingFile("sensor", sensor, folders);
  std::vector<std::string> places{config_dir + "/sensors"};
  places.insert(places.end(), folders.begin(), folders.end());
  return existingFile("sensor", sensor + ".yaml", places);
}

SensorModel loadSensor(ParamTree& tree, const std::string& path) {
  SensorModel sensor;
  sensor.name = fs::path(path).stem().string();
  ParamTree file;
  file.addYamlFile(path);
  file.read("sensor." + sensor.name, sensor);
  file.requireClean();
  tree.read("sensor." + sensor.name, sensor);
  for (const std::string& problem : sensor.problems()) tree.addProblem(problem);
  return sensor;
}

}  // namespace

double longestRange(const RobotModel& robot) {
  double range = 0.0;
  for (const SensorModel& sensor : robot.sensor_models) range = std::max(range, sensor.range_max_m);
  return range;
}

double lookVolume(const RobotModel& robot) {
  double volume = 0.0;
  for (const SensorModel& sensor : robot.sensor_models)
    volume = std::max(volume, lookVolume(sensor));
  return volume;
}

bool seesAllAround(const RobotModel& robot) {
  return std::any_of(robot.sensor_models.begin(), robot.sensor_models.end(),
                     [](const SensorModel& sensor) { return seesAllAround(sensor); });
}

double denseRange(const RobotModel& robot) {
  double range = 0.0;
  for (const SensorModel& sensor : robot.sensor_models)
    range = std::max(range, denseRange(sensor, robot.box_m.z()));
  return range;
}

double longestGainRange(const RobotModel& robot) {
  double range = 0.0;
  for (const SensorModel& sensor : robot.sensor_models) range = std::max(range, gainRange(sensor));
  return range;
}

RobotKind kindOf(const RobotModel& robot) {
  return robot.kind == "legged" ? RobotKind::kLegged : RobotKind::kAerial;
}

std::vector<std::string> RobotModel::problems() const {
  std::vector<std::string> found;
  if (kind != "aerial" && kind != "legged")
    found.push_back("robot '" + name + "': kind '" + kind + "' must be aerial or legged");
  if (sensors.empty()) found.push_back("robot '" + name + "': needs at least one sensor");
  if (acceleration_max_mps2 > braking_deceleration_mps2)
    found.push_back(
        "robot.acceleration_max_mps2 = " + toText(acceleration_max_mps2) +
        " is more than robot.braking_deceleration_mps2 = " + toText(braking_deceleration_mps2) +
        ": planned motion slows down by the first, a stop is the hardest it can do; "
        "lower the first or raise the second");
  if (kind == "legged" && ride_height_m <= 0.0)
    found.push_back("robot.ride_height_m = " + toText(ride_height_m) +
                    ": a legged robot carries its base above the ground; say how high");
  if (const std::string problem = selfFilterBoxes(*this).problem; !problem.empty())
    found.push_back(problem);
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

double narrowSpeed(const RobotModel& robot) {
  const double margin = 0.5 * (kTightShare - kBodyShare) * robot.box_m.head<2>().minCoeff();
  const double braking = robot.braking_deceleration_mps2;
  const double reaction = braking * robot.reaction_time_s;
  // brakingDistance(v) = margin
  const double speed = std::sqrt(reaction * reaction + 2.0 * braking * margin) - reaction;
  return std::min(speed, robot.speed_max_mps);
}

double reachOf(const RobotModel& robot, double time_limit_s) {
  const double away_s = 0.5 * std::min(robot.endurance_s, time_limit_s);
  return robot.speed_max_mps * away_s + longestRange(robot);
}

RobotModel loadRobot(ParamTree& tree, const std::string& name, const std::string& config_dir,
                     const std::vector<std::string>& folders) {
  RobotModel robot;
  robot.name = name;
  tree.read("robot", robot);
  for (const std::string& problem : robot.problems()) tree.addProblem(problem);
  std::set<std::string> names;
  for (const std::string& given : robot.sensors) {
    robot.sensor_models.push_back(loadSensor(tree, sensorFile(given, config_dir, folders)));
    const std::string& sensor_name = robot.sensor_models.back().name;
    if (!names.insert(sensor_name).second)
      tree.addProblem("robot.sensors: two are called '" + sensor_name +
                      "'; rename one of the files, parameters and frames go by their names");
  }
  return robot;
}

}  // namespace spelunk
