#include "spelunk/ros/mission_core.h"

#include <cstdio>

#include "spelunk/common/contract.h"
#include "spelunk/mission/mission_store.h"
#include "spelunk/ros/ros_log.h"

namespace spelunk::bridge {
namespace {

void place(MissionCore& core, const LocalFrame& frame) {
  core.is_placed = true;
  core.frame = frame;
  core.steady.place(frame);
  logToRos(frame);
  if (const std::string text = sayingOf(frame); !text.empty()) log(LogLevel::kInfo, text);
}

}  // namespace

const LocalFrame& frameAt(MissionCore& core, const Eigen::Vector3d& place_of_robot) {
  if (core.is_placed) return core.frame;
  place(core, LocalFrame::around(place_of_robot, core.reach_m, core.range_m));
  (void)core.mission.setBounds(core.frame.toLocal(core.mission.bounds()));
  (void)core.mission.setZones(core.frame.toLocal(core.mission.zones()));
  return core.frame;
}

mission::Answer load(MissionCore& core, const std::string& folder, planners::PlannerGraph& graph) {
  LocalFrame saved;
  try {
    saved = mission::readRecord(folder).frame;
  } catch (const OutsideError& error) {
    return {false, error.what()};
  }
  if (core.is_placed && saved == core.frame) return core.mission.load(folder, &graph);
  if (core.mission.isRunning()) return {false, "load: pause the mission first"};
  mission::Mission fresh = core.make_mission();
  const mission::Answer answer = fresh.load(folder, &graph);
  if (!answer.accepted) return answer;
  core.mission = std::move(fresh);
  core.robot.reset();
  place(core, saved);
  return answer;
}

double missionTime(MissionCore& core, const ::ros::Time& now) {
  const std::optional<double> back_s = core.clock.update(now);
  const double now_s = core.clock.toMission(now);
  if (back_s) {
    ++core.clock_jumps;
    core.mission.pause();
    if (core.has_two_clocks) return now_s;
    char text[200];
    std::snprintf(text, sizeof(text),
                  "the clock jumped back by %.2f s: the robot holds, transforms are forgotten; if "
                  "the robot is where odometry says, call ~start to go on",
                  *back_s);
    core.watch.report("clock jump", text, now_s);
  }
  return now_s;
}

void noteInputs(MissionCore& core, double now_s) {
  const std::string problem =
      core.clock_problem.empty() ? core.watch.waiting(now_s) : core.clock_problem;
  core.mission.noteInputs({problem, core.doubt, core.flaw});
}

}  // namespace spelunk::bridge
