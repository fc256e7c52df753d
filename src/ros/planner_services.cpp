#include "spelunk/ros/planner_services.h"

#include <exception>
#include <optional>
#include <utility>

#include "spelunk/mission/moved_mission.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/ros/convert.h"

namespace spelunk::bridge {
namespace {

constexpr const char* kNoOdometry =
    "no good odometry has arrived yet: check the topic 'odometry' and the node's warnings";

/// So long an urgent request waits for the mission; then it is taken up by the next tick.
constexpr double kUrgentWait_s = 0.05;

constexpr double kCornerError_m = 1e-3;  ///< More is said.

template <class Response>
bool answer(const mission::Answer& given, Response& response, std::string Response::*text) {
  response.success = given.accepted;
  response.*text = given.reason;
  return true;
}

/// What the mission says to `ask`, places in the world frame.
template <class F>
mission::Answer asked(GuardedCore& core, F&& ask) {
  return core.with([&](MissionCore& c) { return c.frame.toCaller(std::forward<F>(ask)(c)); });
}

bool answer(const mission::Answer& given, std_srvs::Trigger::Response& response) {
  return answer(given, response, &std_srvs::Trigger::Response::message);
}

/// Runs what answers a call; an exception becomes success = false with its text.
template <class Response, class F>
bool answering(Response& response, std::string Response::*text, F&& callback) {
  try {
    std::forward<F>(callback)();
  } catch (const std::exception& error) {
    response.success = false;
    response.*text = error.what();
  }
  return true;
}

}  // namespace

PlannerServices::PlannerServices(const ::ros::NodeHandle& private_node,
                                 const std::string& world_frame, const std::string& local_frame,
                                 std::uint64_t seed, const navigation::NavigationParams& navigation,
                                 GuardedCore& core, GuardedPlanner& planner, UrgentRequests& urgent,
                                 HoldNow hold_now)
    : world_frame_(world_frame),
      local_frame_(local_frame),
      navigation_(navigation),
      rng_(seed),
      core_(core),
      planner_(planner),
      urgent_(urgent),
      hold_now_(std::move(hold_now)),
      node_(private_node),
      spinner_(1, &queue_),
      start_node_(private_node),
      start_spinner_(1, &start_queue_),
      urgent_node_(private_node),
      urgent_spinner_(1, &urgent_queue_) {
  node_.setCallbackQueue(&queue_);
  start_node_.setCallbackQueue(&start_queue_);
  urgent_node_.setCallbackQueue(&urgent_queue_);
  using Self = PlannerServices;
  start_server_ = start_node_.advertiseService("start", &Self::start, this);
  urgent_servers_ = {urgent_node_.advertiseService("pause", &Self::pause, this),
                     urgent_node_.advertiseService("home", &Self::home, this),
                     urgent_node_.advertiseService("estop", &Self::emergencyStop, this)};
  servers_ = {node_.advertiseService("plan", &Self::plan, this),
              node_.advertiseService("go_to", &Self::goTo, this),
              node_.advertiseService("set_bounds", &Self::setBounds, this),
              node_.advertiseService("set_no_go_zones", &Self::setZones, this),
              node_.advertiseService("set_local_no_go_zones", &Self::setLocalZones, this),
              node_.advertiseService("save", &Self::save, this),
              node_.advertiseService("load", &Self::load, this)};
  spinner_.start();
  start_spinner_.start();
  urgent_spinner_.start();
}

PlannerServices::~PlannerServices() {
  urgent_spinner_.stop();
  start_spinner_.stop();
  spinner_.stop();
}

/// A robot that is to hold holds even while something long keeps the mission.
mission::Answer PlannerServices::urgently(Urgent what) {
  mission::Answer given;
  const bool is_done = core_.tryWithFor(
      kUrgentWait_s, [&](MissionCore& core) { given = core.frame.toCaller(carryOut(what, core)); });
  if (is_done) return given;
  urgent_.ask(what);
  if (urgent_.holdsRobot()) hold_now_();
  return waitingAnswer(what);
}

Rng PlannerServices::nextRng(const char* service) {
  return rng_.fork(service + std::string("/") + std::to_string(calls_++));
}

bool PlannerServices::start(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answering(response, &Trigger::Response::message, [&] {
    answer(asked(core_,
                 [](MissionCore& core) {
                   const double now_s = missionTime(core, ::ros::Time::now());
                   noteInputs(core, now_s);
                   const mission::Answer given = core.mission.start();
                   if (given.accepted) {
                     core.wants_start = false;
                     core.endurance.start(now_s);
                   }
                   return given;
                 }),
           response);
  });
}

bool PlannerServices::pause(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answering(response, &Trigger::Response::message,
                   [&] { answer(urgently(Urgent::kPause), response); });
}

bool PlannerServices::home(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answering(response, &Trigger::Response::message,
                   [&] { answer(urgently(Urgent::kHome), response); });
}

bool PlannerServices::emergencyStop(Trigger::Request& /*request*/, Trigger::Response& response) {
  return answering(response, &Trigger::Response::message,
                   [&] { answer(urgently(Urgent::kStop), response); });
}

bool PlannerServices::plan(Plan::Request& /*request*/, Plan::Response& response) {
  return answering(response, &Plan::Response::reason, [&] {
    LocalFrame frame;
    const auto request = core_.with([&](MissionCore& core) {
      frame = core.frame;
      return core.mission.requestHere(missionTime(core, ::ros::Time::now()));
    });
    if (!request) {
      response.status = "no_odometry";
      response.reason = kNoOdometry;
      return;
    }
    planners::PlanRequest wanted = *request;
    wanted.rng = nextRng("plan");
    const auto result = planner_.with([&](auto& planner) { return planner->plan(wanted); });
    response.success = result.status == planners::PlanStatus::kOk;
    response.status = planners::toText(result.status);
    response.reason = frame.toCaller(result.reason);
    response.path = bridge::toMsg(frame.toCaller(result.path), world_frame_, ::ros::Time::now());
  });
}

bool PlannerServices::goTo(GoTo::Request& request, GoTo::Response& response) {
  return answering(response, &GoTo::Response::reason, [&] {
    const Eigen::Vector3d target(request.target.x, request.target.y, request.target.z);
    auto job = core_.with([&](MissionCore& core) -> std::optional<mission::PlanJob> {
      const mission::Answer given =
          core.mission.goTo(core.frame.toLocal(target), navigation_, navigation_.planning_time_s);
      response.reason = core.frame.toCaller(given.reason);
      return given.accepted ? core.mission.takeJob() : std::nullopt;
    });
    if (!job) return;
    const mission::PlanOutcome outcome = runJob(*job, planner_);
    core_.with([&](MissionCore& core) {
      core.mission.take(outcome, missionTime(core, ::ros::Time::now()));
      const mission::GoToStatus status = core.frame.toCaller(core.mission.status().go_to);
      response.success = status.outcome == mission::GoToOutcome::kUnderway;
      response.reason = response.success ? "flying to the point that was asked for" : status.reason;
      if (status.nearest_reachable)
        response.reason +=
            "; the nearest point that can be reached is " + toText(*status.nearest_reachable);
      const auto plan = core.mission.goToPlan();
      if (response.success && plan)
        response.path =
            bridge::toMsg(core.frame.toCaller(plan->path), world_frame_, ::ros::Time::now());
    });
  });
}

bool PlannerServices::setBounds(SetBounds::Request& request, SetBounds::Response& response) {
  return answering(response, &SetBounds::Response::reason, [&] {
    const auto bounds = boundsFromMsg(request.min, request.max);
    response.reason = bounds.problem;
    if (!bounds.value) return;
    answer(asked(core_,
                 [&](MissionCore& core) {
                   return core.mission.setBounds(core.frame.toLocal(*bounds.value));
                 }),
           response, &SetBounds::Response::reason);
  });
}

bool PlannerServices::setZones(SetNoGoZones::Request& request, SetNoGoZones::Response& response) {
  return answering(response, &SetNoGoZones::Response::reason, [&] {
    const auto zones = fromMsg(request);
    response.reason = zones.problem;
    if (!zones.value) return;
    mission::Answer given = asked(core_, [&](MissionCore& core) {
      return core.mission.setZones(core.frame.toLocal(*zones.value));
    });
    const double error_m = cornerError(request);
    if (given.accepted && error_m > kCornerError_m)
      given.reason += "; their corners are only exact to " + toText(error_m) +
                      " m, as they are 32-bit numbers: give them in the frame '" + local_frame_ +
                      "' to ~set_local_no_go_zones";
    answer(given, response, &SetNoGoZones::Response::reason);
  });
}

bool PlannerServices::setLocalZones(SetNoGoZones::Request& request,
                                    SetNoGoZones::Response& response) {
  return answering(response, &SetNoGoZones::Response::reason, [&] {
    const auto zones = fromMsg(request);
    response.reason = zones.problem;
    if (!zones.value) return;
    answer(asked(core_,
                 [&](MissionCore& core) {
                   if (core.is_placed) return core.mission.setZones(*zones.value);
                   return mission::Answer{
                       false, "where '" + local_frame_ +
                                  "' lies is known with the first odometry: wait for it, or use "
                                  "~set_no_go_zones"};
                 }),
           response, &SetNoGoZones::Response::reason);
  });
}

bool PlannerServices::save(Save::Request& request, Save::Response& response) {
  return answering(response, &Save::Response::reason, [&] {
    const auto graph = planner_.with([](auto& planner) { return planner->graph(); });
    answer(core_.with([&](MissionCore& core) {
      return core.mission.save(request.path, graph, core.frame);
    }),
           response, &Save::Response::reason);
  });
}

bool PlannerServices::load(Load::Request& request, Load::Response& response) {
  return answering(response, &Load::Response::reason, [&] {
    planners::PlannerGraph graph;
    const mission::Answer given =
        core_.with([&](MissionCore& core) { return bridge::load(core, request.path, graph); });
    if (given.accepted) planner_.with([&](auto& planner) { planner->restore(graph); });
    answer(given, response, &Load::Response::reason);
  });
}

}  // namespace spelunk::bridge
