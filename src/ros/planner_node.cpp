#include "spelunk/ros/planner_node.h"

#include <ros/init.h>

#include <optional>
#include <utility>

#include "spelunk/mission/moved_mission.h"
#include "spelunk/ros/frame_names.h"

namespace spelunk::bridge {
namespace {

constexpr double kStatusPeriod_s = 1.0;
constexpr double kWalkerMarks = 0.25;  ///< Walkers are looked at from near.

}  // namespace

PlannerNode::PlannerNode(const ::ros::NodeHandle& node, const ::ros::NodeHandle& private_node)
    : PlannerNode(node, private_node, loadPlannerSetup(private_node)) {}

PlannerNode::PlannerNode(const ::ros::NodeHandle& node, const ::ros::NodeHandle& private_node,
                         PlannerSetup setup)
    : params_(setup.node),
      node_(node),
      view_node_(node),
      planner_(std::move(setup.planner)),
      core_(setup.mission, setup.robot, setup.map, setup.terrain,
            static_cast<std::uint64_t>(setup.node.seed), setup.node.time_limit_s),
      outputs_(node_, params_.world_frame, localFrame(params_)),
      worker_(planner_, [this](const mission::PlanOutcome& outcome) { takeOver(outcome); }),
      inputs_(node_, params_, setup.cloud, core_),
      services_(private_node, params_.world_frame, localFrame(params_),
                static_cast<std::uint64_t>(params_.seed), setup.navigation, core_, planner_,
                urgent_, [this] { outputs_.publishHold(::ros::Time::now()); }),
      tick_timer_(node_.createTimer(::ros::Duration(1.0 / params_.tick_rate_hz),
                                    [this](const ::ros::TimerEvent&) { tick(); })),
      view_spinner_(1, &view_queue_) {
  view_node_.setCallbackQueue(&view_queue_);
  status_timer_ =
      view_node_.createWallTimer(::ros::WallDuration(kStatusPeriod_s),
                                 [this](const ::ros::WallTimerEvent&) { publishStatus(); });
  view_timer_ =
      view_node_.createWallTimer(::ros::WallDuration(params_.view_period_s),
                                 [this](const ::ros::WallTimerEvent&) { publishViews(); });
  octomap_timer_ =
      view_node_.createWallTimer(::ros::WallDuration(params_.octomap_period_s),
                                 [this](const ::ros::WallTimerEvent&) { publishOctomap(); });
  core_.with([&](MissionCore& core) { core.wants_start = params_.auto_start; });
  view_spinner_.start();
}

PlannerNode::~PlannerNode() { view_spinner_.stop(); }

void PlannerNode::run() { ::ros::spin(); }

void PlannerNode::tick() {
  holdingOnError(core_, "the mission's tick", [&] {
    const auto job = core_.with([&](MissionCore& core) {
      const double now_s = missionTime(core, ::ros::Time::now());
      if (const auto what = urgent_.take()) (void)carryOut(*what, core);
      core.mission.onRemaining(core.endurance.remaining(now_s));
      publishFrameIfNew(core);
      noteInputs(core, now_s);
      const auto command = core.mission.tick(now_s);
      if (command) publish(core, *command);
      if (core.was_corrected && !command) sayCommandAgain(core, now_s);
      core.was_corrected = false;
      startIfWanted(core, now_s);
      core.watch.checkSilence(now_s);
      publishStatusIfChanged(core, now_s);
      return core.mission.takeJob();
    });
    if (job) worker_.submit(*job);
  });
}

void PlannerNode::takeOver(const mission::PlanOutcome& outcome) {
  holdingOnError(core_, "taking over a plan", [&] {
    core_.with([&](MissionCore& core) {
      const double now_s = missionTime(core, ::ros::Time::now());
      if (const auto command = core.mission.accept(outcome, now_s)) publish(core, *command);
      publishStatusIfChanged(core, now_s);
    });
    if (!outputs_.wantsGraph() && !outputs_.wantsMarkers()) return;
    const auto graph = std::make_shared<const planners::PlannerGraph>(
        planner_.with([](auto& planner) { return planner->graph(); }));
    shown_graph_.with([&](auto& shown) { shown = graph; });
    const LocalFrame frame = core_.with([](const MissionCore& core) { return core.frame; });
    outputs_.publishGraph(frame.toCaller(*graph), ::ros::Time::now());
  });
}

void PlannerNode::startIfWanted(MissionCore& core, double now_s) {
  if (!core.wants_start) return;
  const mission::Answer answer = core.mission.start();
  if (answer.accepted) {
    core.wants_start = false;
    core.endurance.start(now_s);
    return;
  }
  if (!waits_since_s_) waits_since_s_ = now_s;
  if (now_s - *waits_since_s_ > params_.silence_s && start_refusals_.allows("start", now_s))
    log(LogLevel::kWarn, "not started yet: " + answer.reason);
}

/// Odometry was corrected: what was commanded lies elsewhere in the world frame now.
void PlannerNode::sayCommandAgain(MissionCore& core, double now_s) {
  if (const auto again = core.mission.commandAgain(now_s)) publish(core, *again);
}

void PlannerNode::publish(MissionCore& core, const mission::Command& command) {
  if (urgent_.holdsRobot()) return;  // the tick that carries it out commands anew
  core.kind = command.kind;
  outputs_.publishCommand(core.frame.toCaller(command), core.clock, ::ros::Time::now());
}

void PlannerNode::publishFrameIfNew(const MissionCore& core) {
  if (!core.is_placed || said_frame_ == core.frame) return;
  said_frame_ = core.frame;
  outputs_.publishFrame(core.frame, ::ros::Time::now());
}

void PlannerNode::publishStatusIfChanged(MissionCore& core, double now_s) {
  const mission::MissionStatus status = core.frame.toCaller(core.mission.status());
  const std::string problem = core.watch.current(now_s);
  const std::string said =
      std::string(mission::toText(status.state)) + status.reason + status.end_reason + problem;
  if (said == last_said_) return;
  last_said_ = said;
  outputs_.publishStatus(status, problem, ::ros::Time::now());
}

void PlannerNode::publishStatus() {
  core_.with([&](MissionCore& core) {
    const ::ros::Time now = ::ros::Time::now();
    checkClock(core, now);
    const std::string problem = core.clock_problem.empty()
                                    ? core.watch.current(core.clock.toMission(now))
                                    : core.clock_problem;
    outputs_.publishStatus(core.frame.toCaller(core.mission.status()), problem, now);
  });
}

/// Here, where real time counts: without a ROS clock nothing else runs.
void PlannerNode::checkClock(MissionCore& core, const ::ros::Time& now) {
  const auto source =
      ::ros::Time::isSystemTime() ? ClockWatch::Source::kSystem : ClockWatch::Source::kSimulated;
  const double real_s = ::ros::SteadyTime::now().toSec();
  core.clock_problem = clock_watch_.check(now, source, real_s);
  if (core.clock_problem.empty()) return;
  noteInputs(core, core.clock.toMission(now));
  if (clock_throttle_.allows("clock", real_s)) log(LogLevel::kWarn, core.clock_problem);
}

MissionView PlannerNode::viewOf(MissionCore& core) const {
  MissionView view;
  view.frame = core.frame;
  view.status = core.frame.toCaller(core.mission.status());
  view.box = core.robot.value_or(RobotState()).pose;
  view.box.position.z() += core.mission.robot().box_lift_m;
  view.box_m = core.mission.robot().box_m;
  if (kindOf(core.mission.robot()) == RobotKind::kLegged) view.mark_scale = kWalkerMarks;
  view.active_path = core.mission.activePath();
  view.kind = core.kind;
  view.go_to = core.mission.goToPlan();
  view.way_home = core.mission.wayHome();
  view.trail = core.mission.trail();
  view.bounds = core.mission.bounds();
  view.zones = core.mission.zones();
  view.remaining = core.mission.remaining();
  view.map = core.mission.map().freeze();
  if (outputs_.wantsTerrain()) view.terrain = core.mission.terrain();
  return view;
}

void PlannerNode::publishOctomap() {
  if (!outputs_.wantsOctomap()) return;
  holdingOnError(core_, "the octomap", [&] {
    core_.with([&](MissionCore& core) {
      outputs_.publishOctomap(core.mission.map(), core.frame, ::ros::Time::now());
    });
  });
}

void PlannerNode::publishViews() {
  holdingOnError(core_, "drawing", [&] {
    if (!outputs_.wantsMarkers() && !outputs_.wantsMapCloud() && !outputs_.wantsTerrain()) return;
    MissionView view = core_.with([&](MissionCore& core) { return viewOf(core); });
    view.graph = shown_graph_.with([](const auto& shown) { return shown; });
    outputs_.publishMarkers(view, ::ros::Time::now());
    outputs_.publishMapCloud(view, ::ros::Time::now());
    outputs_.publishTerrain(view, ::ros::Time::now());
  });
}

}  // namespace spelunk::bridge
