#pragma once

#include <ros/time.h>

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "spelunk/common/local_frame.h"
#include "spelunk/common/log.h"
#include "spelunk/mission/mission.h"
#include "spelunk/mission/mission_frame.h"
#include "spelunk/ros/endurance_source.h"
#include "spelunk/ros/guarded.h"
#include "spelunk/ros/input_watch.h"
#include "spelunk/ros/mission_clock.h"

namespace spelunk::bridge {

/// The mission and what belongs to it; the threads of planner_node share it under one lock. The
/// mission, its map and all that goes into them and comes out of them are in `frame`; messages,
/// services and files are in the world frame. Who passes something from one to the other converts
/// it with `frame` under the same lock.
struct MissionCore {
  MissionCore(const mission::MissionParams& params, const RobotModel& robot_model,
              const map::MapParams& map_params, const terrain::TerrainParams& terrain,
              std::uint64_t seed, double time_limit_s)
      : make_mission(
            [=] { return mission::Mission(params, robot_model, map_params, seed, terrain); }),
        mission(make_mission()),
        steady(robot_model, map_params.resolution_m),
        endurance(robot_model.endurance_s, time_limit_s),
        reach_m(reachOf(robot_model, time_limit_s)),
        range_m(map::keyRange(map_params)) {}

  std::function<mission::Mission()> make_mission;  ///< A new one, as at the node's start.
  mission::Mission mission;
  LocalFrame frame;              ///< The world frame itself until `is_placed`; that of `steady`.
  mission::MissionFrame steady;  ///< Keeps it with the robot while odometry is corrected.
  bool was_corrected = false;    ///< What is commanded is to be said again.
  bool is_placed = false;        ///< A robot was met, or a saved mission was taken up.
  MissionClock clock;
  EnduranceSource endurance;
  double reach_m;  ///< See LocalFrame::around().
  double range_m;
  InputWatch watch;
  std::string clock_problem;        ///< Of the ROS clock; empty while it runs.
  std::string doubt;                ///< As mission::InputNotes has it.
  std::string flaw;                 ///< The same.
  std::optional<RobotState> robot;  ///< The newest odometry that was good, mission time.
  planners::PathKind kind = planners::PathKind::kLocal;  ///< Of the active path.
  bool wants_start = false;       ///< Start as soon as the mission accepts it.
  bool has_two_clocks = false;    ///< That was said; its jumps need not be.
  std::uint64_t clock_jumps = 0;  ///< How often ROS time jumped back.
};

/// The frame of the mission. The first call chooses it for a robot (or its sensor) at `place`,
/// world frame; bounds and zones that were set before are taken along.
const LocalFrame& frameAt(MissionCore& core, const Eigen::Vector3d& place);

/// Takes up what ~save has written, in the frame that it was saved in. If the mission at hand works
/// in another frame a new one takes its place, which has to be told anew where the robot is.
mission::Answer load(MissionCore& core, const std::string& folder, planners::PlannerGraph& graph);

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
