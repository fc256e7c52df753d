#include "run_rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spelunk::mission {
namespace {

using spelunk::toText;  // of numbers; this namespace has its own of states

constexpr double kRounding = 1e-9;

/// "robot.speed_max_mps = 2"
std::string named(const std::string& name, double value) { return name + " = " + toText(value); }

/// Numbers for people, two decimals, rounded so that they may be set as they stand.
std::string atMost(double value) { return toText(std::floor(100.0 * value) / 100.0); }
std::string atLeast(double value) { return toText(std::ceil(100.0 * value) / 100.0); }

/// The sections of a run looked at pair by pair; problems are gathered.
class Rules {
 public:
  explicit Rules(const RunConfig& config) : config_(config), robot_(config.robot) {}

  std::vector<std::string> problems() {
    for (const SensorModel& sensor : robot_.sensor_models) checkSensor(sensor);
    checkMap();
    checkStopping();
    checkMission();
    if (kindOf(robot_) == RobotKind::kLegged) checkGround();
    return std::move(found_);
  }

 private:
  void refuse(const std::string& text) { found_.push_back(text); }

  void checkSensor(const SensorModel& sensor) {
    const std::string section = "sensor." + sensor.name + ".";
    const double map_range = config_.map.range_max_m;
    const double sight = std::min(sensor.range_max_m, map_range);
    if (sensor.gain_range_m > sight + kRounding)
      refuse(named(section + "gain_range_m", sensor.gain_range_m) +
             " is beyond what is seen: " + named(section + "range_max_m", sensor.range_max_m) +
             ", " + named("map.range_max_m", map_range) +
             "; set gain_range_m to 0 (it then follows) or to at most " + toText(sight));
    if (sensor.reports_misses && sensor.range_max_m <= map_range)
      refuse(section + "reports_misses: " + named("map.range_max_m", map_range) +
             " must be below " + named(section + "range_max_m", sensor.range_max_m) +
             ", or the sensor's misses become obstacles; set map.range_max_m to 0 (it then "
             "follows) or to a shorter range");
    if (config_.map.range_min_m >= sight)
      refuse(named("map.range_min_m", config_.map.range_min_m) + " drops all that " +
             named(section + "range_max_m", sensor.range_max_m) +
             " lets the sensor see: lower map.range_min_m");
  }

  void checkMap() {
    const double thinnest = robot_.box_m.minCoeff();
    if (config_.map.resolution_m > thinnest + kRounding)
      refuse(named("map.resolution_m", config_.map.resolution_m) +
             " is coarser than the robot is thin, robot.box_m = " + toText(robot_.box_m) +
             ": set it to at most " + toText(thinnest));
    if (config_.navigation.extension_m < config_.map.resolution_m)
      refuse(named("navigation.extension_m", config_.navigation.extension_m) +
             " is shorter than a voxel, " + named("map.resolution_m", config_.map.resolution_m) +
             ": raise it or make the map finer");
  }

  /// Way to a standstill from an obstacle that came into sight just after a scan was mapped, to be
  /// seen from the middle of the box.
  [[nodiscard]] double stoppingNeed(double speed_mps, const SensorModel& sensor) const {
    const double interval_s = std::max(1.0 / sensor.rate_hz, sensor.mapping_period_s);
    return brakingDistance(robot_, speed_mps) + speed_mps * interval_s + 0.5 * robot_.box_m.x();
  }

  /// The robot must be able to stop within what one of its sensors sees.
  void checkStopping() {
    const SensorModel* best = nullptr;
    const auto room = [&](const SensorModel& sensor) {
      return std::min(sensor.range_max_m, config_.map.range_max_m) -
             stoppingNeed(robot_.speed_max_mps, sensor);
    };
    for (const SensorModel& sensor : robot_.sensor_models)
      if (best == nullptr || room(sensor) > room(*best)) best = &sensor;
    if (best == nullptr || room(*best) >= 0.0) return;
    const double sight = std::min(best->range_max_m, config_.map.range_max_m);
    refuse(named("robot.speed_max_mps", robot_.speed_max_mps) + " needs " +
           atLeast(stoppingNeed(robot_.speed_max_mps, *best)) + " m to stop (" +
           named("robot.braking_deceleration_mps2", robot_.braking_deceleration_mps2) + ", " +
           named("robot.reaction_time_s", robot_.reaction_time_s) +
           ", the time between mapped scans and half the robot's box included), but sensor '" +
           best->name + "' sees " + toText(sight) + " m (the shorter of its range_max_m and " +
           "map.range_max_m): " + remedyFor(*best, sight));
  }

  [[nodiscard]] std::string remedyFor(const SensorModel& sensor, double sight_m) const {
    const double interval_s = std::max(1.0 / sensor.rate_hz, sensor.mapping_period_s);
    const double lag_s = robot_.reaction_time_s + interval_s;
    const double brake = robot_.braking_deceleration_mps2;
    const double way = sight_m - 0.5 * robot_.box_m.x();
    const double speed =
        brake * (std::sqrt(lag_s * lag_s + 2.0 * std::max(0.0, way) / brake) - lag_s);
    if (speed < 0.01) return "the sensor sees no farther than the robot's own box";
    return "set robot.speed_max_mps to at most " + atMost(speed) + ", or map scans more often";
  }

  void checkMission() {
    const MissionParams& mission = config_.mission;
    const double share_s = 0.01 * mission.reserve_percent * robot_.endurance_s;
    if (std::max(mission.reserve_s, share_s) >= robot_.endurance_s)
      refuse(named("mission.reserve_s", mission.reserve_s) + " (or " +
             named("mission.reserve_percent", mission.reserve_percent) + ") keeps back all of " +
             named("robot.endurance_s", robot_.endurance_s) +
             ": lower the reserve, or no mission can begin");
    if (mission.home_radius_m < config_.map.resolution_m)
      refuse(named("mission.home_radius_m", mission.home_radius_m) + " is less than a voxel, " +
             named("map.resolution_m", config_.map.resolution_m) +
             ": ways home end a voxel apart; raise it to at least that");
    if (mission.deviation_max_m < 0.5 * config_.map.resolution_m)
      refuse(named("mission.deviation_max_m", mission.deviation_max_m) +
             " is less than half a voxel, " + named("map.resolution_m", config_.map.resolution_m) +
             ": paths are no more exact; raise it to at least half of that");
    if (mission.plan_ahead_s > mission.replan_period_s)
      refuse(named("mission.plan_ahead_s", mission.plan_ahead_s) + " is more than " +
             named("mission.replan_period_s", mission.replan_period_s) +
             ": a path would be renewed before it is begun; set replan_period_s to at least " +
             "plan_ahead_s");
  }

  /// Rules for the ground under a walking robot: "terrain" looks at cells, "robot" at paths.
  void checkGround() {
    const auto& [elevation, cells, footprint] = config_.terrain;
    if (std::fabs(elevation.base_height_m - robot_.ride_height_m) >
        config_.terrain.elevation.cell_m)
      refuse(named("terrain.base_height_m", elevation.base_height_m) + " and " +
             named("robot.ride_height_m", robot_.ride_height_m) +
             " are the same height: set terrain.base_height_m to 0 (it then follows)");
    if (cells.slope_limit_deg < robot_.slope_max_deg)
      refuse(named("terrain.slope_limit_deg", cells.slope_limit_deg) + " is less than " +
             named("robot.slope_max_deg", robot_.slope_max_deg) +
             ": paths would be planned over ground that is refused; raise the limit or lower the "
             "robot's slope");
    if (cells.step_limit_m < robot_.step_max_m)
      refuse(named("terrain.step_limit_m", cells.step_limit_m) + " is less than " +
             named("robot.step_max_m", robot_.step_max_m) +
             ": paths would be planned over steps that are refused; raise the limit or lower the "
             "robot's step");
    if (footprint.footprint_length_m > robot_.box_m.x() + kRounding ||
        footprint.footprint_width_m > robot_.box_m.y() + kRounding)
      refuse(named("terrain.footprint_length_m", footprint.footprint_length_m) + " or " +
             named("terrain.footprint_width_m", footprint.footprint_width_m) +
             " is more than the robot's box, robot.box_m = " + toText(robot_.box_m) +
             ": feet do not step outside it; lower the footprint");
    checkGroundReach(elevation.reach_m, footprint.footprint_length_m);
  }

  /// A walking robot must be able to stop on ground that it knows.
  void checkGroundReach(double reach_m, double footprint_m) {
    const double need_m = brakingDistance(robot_, robot_.speed_max_mps) + 0.5 * footprint_m;
    if (reach_m >= need_m) return;
    refuse(named("terrain.reach_m", reach_m) + " is less than the " + atLeast(need_m) +
           " m in which the robot stops from " +
           named("robot.speed_max_mps", robot_.speed_max_mps) +
           " (half its footprint included): raise the reach or lower the speed");
  }

  const RunConfig& config_;
  const RobotModel& robot_;
  std::vector<std::string> found_;
};

}  // namespace

double mapRangeFor(const RunConfig& config) {
  double range = longestRange(config.robot);
  for (const SensorModel& sensor : config.robot.sensor_models)
    if (sensor.reports_misses)
      range = std::min(
          range, std::max(sensor.range_max_m - config.map.resolution_m, 0.5 * sensor.range_max_m));
  return range > 0.0 ? range : map::MapParams{}.range_max_m;
}

std::vector<std::string> problemsBetween(const RunConfig& config) {
  return Rules(config).problems();
}

}  // namespace spelunk::mission
