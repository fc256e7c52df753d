#include "spelunk/ros/mission_core.h"

#include <cstdio>

namespace spelunk::bridge {

double missionTime(MissionCore& core, const ::ros::Time& now) {
  const std::optional<double> back_s = core.clock.update(now);
  const double now_s = core.clock.toMission(now);
  if (back_s) {
    ++core.clock_jumps;
    core.mission.pause();
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
