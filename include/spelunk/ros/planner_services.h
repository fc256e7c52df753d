#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <spelunk/GoTo.h>
#include <spelunk/Load.h>
#include <spelunk/Plan.h>
#include <spelunk/Save.h>
#include <spelunk/SetBounds.h>
#include <spelunk/SetNoGoZones.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "spelunk/ros/mission_core.h"
#include "spelunk/ros/plan_worker.h"
#include "spelunk/ros/urgent_requests.h"

namespace spelunk::bridge {

/// The services of planner_node. Each answers with success and a reason; none fails as a call, and
/// none answers "true" with an empty path. Has its own queues and threads: ~plan, ~go_to, ~save and
/// ~load wait until a running plan is done. ~start waits for the mission only, and what stops the
/// robot or calls it home waits for none of them.
class PlannerServices {
 public:
  /// Tells the robot to hold, at once and without the mission.
  using HoldNow = std::function<void()>;

  /// `core`, `planner` and `urgent` must outlive this. `seed`: of ~plan's and ~go_to's random
  /// draws.
  PlannerServices(const ::ros::NodeHandle& private_node, const std::string& world_frame,
                  const std::string& local_frame, std::uint64_t seed,
                  const navigation::NavigationParams& navigation, GuardedCore& core,
                  GuardedPlanner& planner, UrgentRequests& urgent, HoldNow hold_now);
  ~PlannerServices();

 private:
  using Trigger = std_srvs::Trigger;

  bool start(Trigger::Request& request, Trigger::Response& response);
  bool pause(Trigger::Request& request, Trigger::Response& response);
  bool home(Trigger::Request& request, Trigger::Response& response);
  bool emergencyStop(Trigger::Request& request, Trigger::Response& response);
  bool plan(Plan::Request& request, Plan::Response& response);
  bool goTo(GoTo::Request& request, GoTo::Response& response);
  bool setBounds(SetBounds::Request& request, SetBounds::Response& response);
  bool setZones(SetNoGoZones::Request& request, SetNoGoZones::Response& response);
  bool setLocalZones(SetNoGoZones::Request& request, SetNoGoZones::Response& response);
  bool save(Save::Request& request, Save::Response& response);
  bool load(Load::Request& request, Load::Response& response);

  [[nodiscard]] mission::Answer urgently(Urgent what);
  /// The draws of the next ~plan or ~go_to.
  [[nodiscard]] Rng nextRng(const char* service);

  std::string world_frame_;
  std::string local_frame_;
  navigation::NavigationParams navigation_;
  Rng rng_;
  int calls_ = 0;
  GuardedCore& core_;
  GuardedPlanner& planner_;
  UrgentRequests& urgent_;
  HoldNow hold_now_;

  ::ros::NodeHandle node_;
  ::ros::CallbackQueue queue_;
  std::vector<::ros::ServiceServer> servers_;
  ::ros::AsyncSpinner spinner_;
  ::ros::NodeHandle start_node_;
  ::ros::CallbackQueue start_queue_;
  ::ros::ServiceServer start_server_;
  ::ros::AsyncSpinner start_spinner_;
  ::ros::NodeHandle urgent_node_;
  ::ros::CallbackQueue urgent_queue_;
  std::vector<::ros::ServiceServer> urgent_servers_;
  ::ros::AsyncSpinner urgent_spinner_;
};

}  // namespace spelunk::bridge
