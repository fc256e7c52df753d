#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/timer.h>
#include <ros/wall_timer.h>

#include <memory>
#include <optional>
#include <string>

#include "spelunk/ros/clock_watch.h"
#include "spelunk/ros/mission_core.h"
#include "spelunk/ros/node_params.h"
#include "spelunk/ros/node_setup.h"
#include "spelunk/ros/plan_worker.h"
#include "spelunk/ros/planner_inputs.h"
#include "spelunk/ros/planner_outputs.h"
#include "spelunk/ros/planner_services.h"
#include "spelunk/ros/urgent_requests.h"

namespace spelunk::bridge {

/// Explores with whatever robot or simulator sends clouds, odometry and tf. Converts, calls the
/// mission and publishes; it decides nothing.
///
/// Threads: sensors (PlannerInputs), services (PlannerServices), one planner worker (PlanWorker),
/// one that publishes views, and the caller's, which runs the mission's tick.
class PlannerNode {
 public:
  /// Throws OutsideError with everything that is wrong with the parameters.
  PlannerNode(const ::ros::NodeHandle& node, const ::ros::NodeHandle& private_node);

  ~PlannerNode();

  /// Works until ROS shuts down.
  void run();

 private:
  PlannerNode(const ::ros::NodeHandle& node, const ::ros::NodeHandle& private_node,
              PlannerSetup setup);

  void tick();
  void takeOver(const mission::PlanOutcome& outcome);
  void startIfWanted(MissionCore& core, double now_s);
  void publishFrameIfNew(const MissionCore& core);
  void publishStatusIfChanged(MissionCore& core, double now_s);
  void publishStatus();
  void publishOctomap();
  void checkClock(MissionCore& core, const ::ros::Time& now);
  void publishViews();
  [[nodiscard]] MissionView viewOf(MissionCore& core) const;
  void publish(MissionCore& core, const mission::Command& command);
  void sayCommandAgain(MissionCore& core, double now_s);

  PlannerNodeParams params_;
  ::ros::NodeHandle node_;
  ::ros::CallbackQueue view_queue_;
  ::ros::NodeHandle view_node_;
  GuardedPlanner planner_;
  GuardedCore core_;
  Guarded<std::shared_ptr<const planners::PlannerGraph>> shown_graph_;
  PlannerOutputs outputs_;  ///< Commands and status: with the core locked; views: in one thread.
  std::optional<LocalFrame> said_frame_;  ///< The newest one told to tf; with the core locked.
  std::string last_said_;  ///< State and reason of the newest status; with the core locked.
  Throttle start_refusals_;
  ClockWatch clock_watch_;               ///< With the core locked.
  Throttle clock_throttle_;              ///< In real time; with the core locked.
  std::optional<double> waits_since_s_;  ///< To start; mission time; with the core locked.
  UrgentRequests urgent_;
  PlanWorker worker_;
  PlannerInputs inputs_;
  PlannerServices services_;
  ::ros::Timer tick_timer_;
  ::ros::WallTimer status_timer_;
  ::ros::WallTimer view_timer_;
  ::ros::WallTimer octomap_timer_;
  ::ros::AsyncSpinner view_spinner_;
};

}  // namespace spelunk::bridge
