#pragma once

#include <ros/time.h>

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "spelunk/common/log.h"
#include "spelunk/mission/mission.h"
#include "spelunk/ros/endurance_source.h"
#include "spelunk/ros/guarded.h"
#include "spelunk/ros/input_watch.h"
#include "spelunk/ros/mission_clock.h"

namespace spelunk::bridge {

/// The mission and what belongs to it; the threads of planner_node share it under one lock.
struct MissionCore {
  MissionCore(const mission::MissionParams& params, const RobotModel& robot_model,
              const map::MapParams& map_params, const terrain::TerrainParams& terrain,
              std::uint64_t seed, double time_limit_s)
      : mission(params, robot_model, map_params, seed, terrain),
        endurance(robot_model.endurance_s, time_limit_s) {}

  mission::Mission mission;
  MissionClock clock;
  EnduranceSource endurance;
  InputWatch watch;
  std::string clock_problem;        ///< Of the ROS clock; empty while it runs.
  std::string doubt;                ///< As mission::InputNotes has it.
  std::string flaw;                 ///< The same.
  std::optional<RobotState> robot;  ///< The newest odometry that was good, mission time.
  planners::PathKind kind = planners::PathKind::kLocal;  ///< Of the active path.
  bool wants_start = false;       ///< Start as soon as the mission accepts it.
  std::uint64_t clock_jumps = 0;  ///< How often ROS time jumped back.
};

using GuardedCore = Guarded<MissionCore>;

/// Mission time of `now`. If the ROS clock jumped back, the robot holds and it is said so.
double missionTime(MissionCore& core, const ::ros::Time& now);

/// Tells the mission what is known of its inputs now.
void noteInputs(MissionCore& core, double now_s);

/// Runs a callback. If it throws, the error is logged and the robot holds.
template <class F>
void holdingOnError(GuardedCore& core, const char* what, F&& callback) {
  try {
    std::forward<F>(callback)();
  } catch (const std::exception& error) {
    const std::string text = std::string(what) + " failed, the robot holds: " + error.what();
    core.with([&](MissionCore& inside) {
      inside.mission.pause();
      inside.watch.report(what, text, inside.clock.toMission(::ros::Time::now()));
    });
  }
}

}  // namespace spelunk::bridge
