#include "spelunk/ros/sim_node.h"

#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/UInt32.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "spelunk/navigation/trajectory_timing.h"
#include "spelunk/ros/convert.h"
#include "spelunk/ros/convert_robot.h"
#include "spelunk/ros/frame_names.h"
#include "spelunk/ros/mesh_marker.h"
#include "spelunk/ros/pacer.h"
#include "spelunk/ros/tf_input.h"

namespace spelunk::bridge {
namespace {

constexpr double kBatteryPeriod_s = 0.5;
constexpr double kVoltage_v = 14.8;
constexpr double kClockPatience_s = 5.0;  ///< Wall time without /clock that is said.
constexpr double kClockJump_s = 1.0;
constexpr double kClockLook_s = 0.002;  ///< Wall time between looks at /clock.

geometry_msgs::TransformStamped transformMsg(const Eigen::Isometry3d& T_parent_child,
                                             const std::string& parent, const std::string& child,
                                             const ::ros::Time& stamp) {
  geometry_msgs::TransformStamped message = tf2::eigenToTransform(T_parent_child);
  message.header.frame_id = parent;
  message.header.stamp = stamp;
  message.child_frame_id = child;
  return message;
}

}  // namespace

SimNode::SimNode(const ::ros::NodeHandle& node, const SimSetup& setup, const SimWorld& world)
    : params_(setup.node),
      robot_(setup.robot),
      frame_(world.mesh.frame),
      base_frame_(prefixed(params_.frame_prefix, params_.base_frame)),
      local_frame_(frame_.isCallers() ? params_.world_frame
                                      : prefixed(params_.frame_prefix, "local_mesh")),
      mesh_(meshMarker(world.mesh, local_frame_)),
      simulator_(setup.sim, setup.robot, world.mesh, world.start,
                 static_cast<std::uint64_t>(params_.seed)),
      node_(node),
      odometry_(node_.advertise<nav_msgs::Odometry>("odometry", 50)),
      cloud_(node_.advertise<sensor_msgs::PointCloud2>("pointcloud", 5)),
      battery_(node_.advertise<sensor_msgs::BatteryState>("battery", 5)),
      collisions_(node_.advertise<std_msgs::UInt32>("collisions", 5, /*latch=*/true)),
      mesh_publisher_(node_.advertise<visualization_msgs::Marker>(
          "mesh", 1,
          [this](const ::ros::SingleSubscriberPublisher& subscriber) {
            subscriber.publish(mesh_);
          })),
      trajectory_subscriber_(node_.subscribe("command/trajectory", 5, &SimNode::onTrajectory, this,
                                             ::ros::TransportHints().tcpNoDelay())),
      path_subscriber_(node_.subscribe("path", 5, &SimNode::onPath, this)),
      drive_subscriber_(node_.subscribe("cmd_vel", 5, &SimNode::onDrive, this,
                                        ::ros::TransportHints().tcpNoDelay())),
      stand_subscriber_(node_.subscribe("command/stand", 5, &SimNode::onStand, this)) {
  if (params_.clock) clock_subscriber_ = node_.subscribe("/clock", 10, &SimNode::onClock, this);
  if (params_.clock) clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", 10);
  if (!frame_.isCallers())
    static_broadcaster_.sendTransform(
        frameMsg(frame_, params_.world_frame, local_frame_, ::ros::Time::now()));
  if (kindOf(robot_) == RobotKind::kLegged) walker_outputs_.emplace(node_, local_frame_);
}

void SimNode::run() {
  if (!params_.clock) return runByClock();
  Pacer pacer(params_.speed_factor);
  const double step_s = 1.0 / params_.odometry_rate_hz;
  for (std::int64_t number = 1; ::ros::ok(); ++number) {
    const double time_s = static_cast<double>(number) * step_s;
    const double pause_s = pacer.pause(time_s, ::ros::WallTime::now().toSec());
    ::ros::getGlobalCallbackQueue()->callAvailable(::ros::WallDuration(pause_s));
    const double left_s = pacer.pause(time_s, ::ros::WallTime::now().toSec());
    if (left_s > 0.0) ::ros::WallDuration(left_s).sleep();
    step(time_s);
  }
}

void SimNode::runByClock() {
  const double step_s = 1.0 / params_.odometry_rate_hz;
  while (::ros::ok() && ::ros::Time::now().isZero())
    if (!::ros::Time::waitForValid(::ros::WallDuration(kClockPatience_s)))
      log(LogLevel::kWarn,
          "waiting for /clock, which another simulator has to publish: start one with ~clock true");
  begin_s_ = ::ros::Time::now().toSec();
  for (std::int64_t number = 1; ::ros::ok();) {
    const double time_s = static_cast<double>(number) * step_s;
    const double early_s = begin_s_ + time_s - ::ros::Time::now().toSec();
    ::ros::getGlobalCallbackQueue()->callAvailable(
        ::ros::WallDuration(early_s > 0.0 ? kClockLook_s : 0.0));
    if (early_s > kClockJump_s) begin_s_ -= early_s;  // /clock began anew: go on with it
    if (early_s > 0.0) continue;
    step(time_s);
    ++number;
  }
}

void SimNode::step(double time_s) {
  const auto scans = simulator_.advanceTo(time_s);
  publishClock();
  publishState();
  publishScans(scans);
  publishCollisions();
  if (walker_outputs_) walker_outputs_->publish(simulator_, stampOf(simulator_.time()));
  if (time_s < next_battery_s_) return;
  next_battery_s_ = time_s + kBatteryPeriod_s;
  publishBattery();
}

void SimNode::publishClock() {
  if (!params_.clock) return;
  rosgraph_msgs::Clock message;
  message.clock = stampOf(simulator_.time());
  clock_.publish(message);
}

void SimNode::publishState() {
  const RobotState state = frame_.toCaller(simulator_.odometry());
  const ::ros::Time stamp = stampOf(simulator_.time());
  std::vector<geometry_msgs::TransformStamped> transforms = {
      transformMsg(T_world_body(state), params_.world_frame, base_frame_, stamp)};
  for (const SensorModel& sensor : robot_.sensor_models)
    transforms.push_back(transformMsg(T_base_sensor(sensor), base_frame_,
                                      prefixed(params_.frame_prefix, sensor.name), stamp));
  broadcaster_.sendTransform(transforms);
  if (odometry_.getNumSubscribers() > 0)
    odometry_.publish(toMsg(state, params_.world_frame, base_frame_, stamp));
}

void SimNode::publishScans(const std::vector<sim::SimulatedScan>& scans) {
  if (cloud_.getNumSubscribers() == 0) return;
  for (const sim::SimulatedScan& scan : scans)
    cloud_.publish(toMsg(scan.scan.points, prefixed(params_.frame_prefix, scan.scan.sensor),
                         stampOf(scan.scan.stamp_s)));
}

void SimNode::publishBattery() {
  if (battery_.getNumSubscribers() == 0) return;
  const sim::BatteryState state = simulator_.battery();
  sensor_msgs::BatteryState message;
  message.header.stamp = stampOf(simulator_.time());
  message.present = true;
  message.voltage = static_cast<float>(kVoltage_v);
  message.charge = static_cast<float>(state.energy_wh / kVoltage_v);
  const double capacity_ah =
      state.fraction > 0.0 ? state.energy_wh / state.fraction / kVoltage_v : 0.0;
  message.capacity = static_cast<float>(capacity_ah);
  message.design_capacity = message.capacity;
  message.percentage = static_cast<float>(state.fraction);
  // The mean current, so that charge over current is the time left.
  const double mean_power_w =
      state.remaining_s > 0.0 ? state.energy_wh * 3600.0 / state.remaining_s : state.power_w;
  message.current = static_cast<float>(-mean_power_w / kVoltage_v);
  message.power_supply_status = sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_DISCHARGING;
  battery_.publish(message);
}

void SimNode::publishCollisions() {
  const int episodes = simulator_.collisions().episodes;
  if (collisions_said_ == episodes) return;
  collisions_said_ = episodes;
  std_msgs::UInt32 message;
  message.data = static_cast<std::uint32_t>(episodes);
  collisions_.publish(message);
  if (episodes > 0)
    log(LogLevel::kWarn, "the robot touched the mesh (" + std::to_string(episodes) + " so far)");
}

void SimNode::refuse(const std::string& what, const std::string& problem) {
  if (throttle_.allows(what, simulator_.time()))
    log(LogLevel::kWarn, what + " refused, the robot holds: it " + problem);
  simulator_.follow({});
}

void SimNode::onClock(const ::ros::MessageEvent<rosgraph_msgs::Clock const>& event) {
  const auto both = senders_.heard("/clock", event.getPublisherName());
  if (both) log(LogLevel::kError, twoClocksText(both->first, both->second));
}

void SimNode::onTrajectory(const trajectory_msgs::MultiDOFJointTrajectory::ConstPtr& message) {
  obeys_trajectories_ = true;
  auto trajectory = fromMsg(*message, params_.world_frame);
  if (!trajectory.value) return refuse("command/trajectory", trajectory.problem);
  for (TrajectoryPoint& point : *trajectory.value) point.time_s -= begin_s_;
  simulator_.follow(frame_.toLocal(std::move(*trajectory.value)));
}

void SimNode::onPath(const nav_msgs::Path::ConstPtr& message) {
  if (obeys_trajectories_) return;
  const auto path = fromMsg(*message, params_.world_frame);
  if (!path.value) return refuse("path", path.problem);
  if (path.value->empty()) return simulator_.follow({});
  const RobotState state = simulator_.odometry();
  Path from_here = frame_.toLocal(*path.value);
  from_here.insert(from_here.begin(), state.pose);
  simulator_.follow(navigation::timed(from_here, limitsOf(robot_),
                                      {simulator_.time(), state.velocity, state.yaw_rate}));
}

void SimNode::onStand(const std_msgs::Bool::ConstPtr& message) {
  simulator_.take(message->data ? Posture::kStand : Posture::kLie);
}

void SimNode::onDrive(const geometry_msgs::Twist::ConstPtr& message) {
  const auto command = fromMsg(*message);
  if (!command.value) return refuse("cmd_vel", command.problem);
  const sim::DriveAnswer answer = simulator_.drive(*command.value);
  if (!answer.warning.empty() && throttle_.allows("cmd_vel limits", simulator_.time()))
    log(LogLevel::kWarn, "cmd_vel: " + answer.warning);
}

}  // namespace spelunk::bridge
