#include "mission_impl.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr double kStartGap_m = 0.5;

}  // namespace

std::string Mission::Impl::goToProblem(const Path& path) {
  if (state == MissionState::kEStop) return "emergency stop is on: start releases it";
  if (isFlying()) return "the mission is running: pause it first";
  const std::string problem = startProblem();
  if (!problem.empty()) return problem;
  if (!isAtRest()) return "the robot still moves: wait until it holds";
  if (path.size() < 2) return "the path is empty";
  if (distance(path.front(), input.latest()->pose) > kStartGap_m)
    return "the path does not begin where the robot is";
  const auto check = navigation::checkPath(spaceOf(robot.box_m), path, no_go, limits);
  if (!check.isFree())
    return std::string("the path is not clear: ") + navigation::toText(check.fault);
  return "";
}

Answer Mission::Impl::goTo(const Path& base_path) {
  Path path = base_path;
  for (Pose& pose : path) pose.position.z() += robot.box_lift_m;
  std::string problem = goToProblem(path);
  if (problem.empty()) {
    takeOff();
    refreshWayHome();
    if (affordableLength(path, std::nullopt) < lengthOf(path))
      problem = "no way home from its end fits the endurance";
  }
  if (!problem.empty()) return {false, problem};
  goal = Goal::kGoTo;
  fly(path, planners::PathKind::kReposition, robot.box_m);
  status.reason = "flying to the point that was asked for";
  return {true, status.reason};
}

void Mission::Impl::stepGoTo() {
  if (goal != Goal::kGoTo || active) return;
  goal = Goal::kNone;
  if (state != MissionState::kHold)
    hold("reached the point that was asked for", planners::PathOutcome::kReached);
}

std::optional<planners::PlanRequest> Mission::Impl::requestHere(double now_s) {
  if (!input.latest()) return std::nullopt;
  planners::PlanRequest request;
  request.map = map.freeze();
  request.time_s = now_s;
  request.pose = input.latest()->pose;
  request.velocity = input.latest()->velocity;
  request.home = home_graph ? home_graph->home() : request.pose;
  request.remaining_s = guard.disposable(0.0);
  request.bounds = limits;
  request.zones = no_go;
  request.trail = stamped_trail;
  request.budget.iterations = params.max_samples;
  return request;
}

}  // namespace spelunk::mission
