#include "spelunk/ros/planner_inputs.h"

#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <utility>

#include "spelunk/ros/convert.h"
#include "spelunk/ros/frame_names.h"

namespace spelunk::bridge {
namespace {

constexpr double kTimerPeriod_s = 0.02;
constexpr std::uint32_t kCloudQueue = 5;
constexpr std::uint32_t kOdometryQueue = 50;

}  // namespace

PlannerInputs::PlannerInputs(const ::ros::NodeHandle& node, const PlannerNodeParams& params,
                             const CloudParams& cloud_params, GuardedCore& core)
    : params_(params),
      cloud_params_(cloud_params),
      core_(core),
      endurance_s_(core.with([](MissionCore& c) { return c.mission.robot().endurance_s; })),
      pending_(cloud_params),
      sensors_(core.with([](MissionCore& c) { return c.mission.robot(); }), params.silence_s),
      node_(node),
      tf_buffer_(::ros::Duration(30.0)),
      tf_input_(tf_buffer_, [this](TfInput::SentByTwo what,
                                   const std::string& text) { reportSenders(what, text); }),
      spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  const ::ros::TransportHints fast = ::ros::TransportHints().tcpNoDelay();
  cloud_subscriber_ =
      node_.subscribe("pointcloud", kCloudQueue, &PlannerInputs::onCloud, this, fast);
  odometry_subscriber_ =
      node_.subscribe("odometry", kOdometryQueue, &PlannerInputs::onOdometry, this, fast);
  battery_subscriber_ = node_.subscribe("battery", 5, &PlannerInputs::onBattery, this);
  timer_ = node_.createTimer(::ros::Duration(kTimerPeriod_s),
                             [this](const ::ros::TimerEvent&) { onTimer(); });
  core_.with([&](MissionCore& c) {
    const double now_s = missionTime(c, ::ros::Time::now());
    cloud_input_ =
        c.watch.expect({node_.resolveName("pointcloud"), "pointcloud", params_.silence_s}, now_s);
    odometry_input_ =
        c.watch.expect({node_.resolveName("odometry"), "odometry", params_.silence_s}, now_s);
  });
  spinner_.start();
}

PlannerInputs::~PlannerInputs() { spinner_.stop(); }

void PlannerInputs::report(const std::string& key, const std::string& text) {
  core_.with(
      [&](MissionCore& c) { c.watch.report(key, text, missionTime(c, ::ros::Time::now())); });
}

void PlannerInputs::forgetAfterClockJump() {
  const auto jumps = core_.with([](MissionCore& c) {
    missionTime(c, ::ros::Time::now());
    return c.clock_jumps;
  });
  if (jumps == jumps_seen_) return;
  jumps_seen_ = jumps;
  tf_was_there_ = false;
  pending_.clear();
  tf_buffer_.clear();
}

FromMsg<Eigen::Isometry3d> PlannerInputs::findTransform(const std::string& frame,
                                                        const ::ros::Time& stamp) const {
  if (frame == params_.world_frame) return {Eigen::Isometry3d::Identity(), ""};
  try {
    const Eigen::Isometry3d T =
        tf2::transformToEigen(tf_buffer_.lookupTransform(params_.world_frame, frame, stamp));
    if (!T.matrix().allFinite()) return {std::nullopt, "the transform is not finite"};
    return {T, ""};
  } catch (const tf2::TransformException& error) {
    return {std::nullopt, error.what()};
  }
}

bool PlannerInputs::hasTransform(const std::string& frame) const {
  return findTransform(frame, ::ros::Time(0)).value.has_value();
}

void PlannerInputs::onCloud(const sensor_msgs::PointCloud2::ConstPtr& cloud) {
  holdingOnError(core_, "pointcloud", [&] {
    forgetAfterClockJump();
    const ::ros::Time now = ::ros::Time::now();
    if (now.isZero()) return;  // Simulated time has not begun.
    core_.with([&](MissionCore& c) { c.watch.heard(cloud_input_, missionTime(c, now)); });
    const std::string problem = pending_.push(cloud, now);
    if (!problem.empty()) report("cloud stamp or frame", problem);
    enterReadyClouds(now);
  });
}

void PlannerInputs::onTimer() {
  holdingOnError(core_, "waiting clouds", [&] {
    forgetAfterClockJump();
    enterReadyClouds(::ros::Time::now());
    sayWhichSensorsAreMissing();
    sayIfOdometryComesFromTwo();
  });
}

void PlannerInputs::reportSenders(TfInput::SentByTwo what, const std::string& text) {
  core_.with([&](MissionCore& c) {
    if (what == TfInput::SentByTwo::kClock) c.has_two_clocks = true;
    c.watch.report(text, text, missionTime(c, ::ros::Time::now()));
  });
}

void PlannerInputs::sayIfOdometryComesFromTwo() {
  if (two_odometries_said_ || odometry_subscriber_.getNumPublishers() < 2) return;
  two_odometries_said_ = true;
  const std::string topic = node_.resolveName("odometry");
  report("odometry senders", "several nodes publish '" + topic +
                                 "': the robot seems to jump to and fro; put each robot into a "
                                 "namespace of its own, or remap 'odometry' in the launch file");
}

void PlannerInputs::sayWhichSensorsAreMissing() {
  core_.with([&](MissionCore& c) {
    const double now_s = missionTime(c, ::ros::Time::now());
    for (const std::string& text : sensors_.news(now_s)) c.watch.report(text, text, now_s);
  });
}

void PlannerInputs::enterReadyClouds(const ::ros::Time& now) {
  const auto lookup = [this](const std::string& frame, const ::ros::Time& stamp) {
    return findTransform(frame, stamp);
  };
  for (const PendingClouds::Item& item : pending_.take(lookup, now)) {
    if (item.problem.empty()) {
      tf_was_there_ = true;
      enter(item);
    } else if (tf_was_there_ || !hasTransform(item.cloud->header.frame_id)) {
      report("cloud transform", item.problem);
    }
  }
}

void PlannerInputs::enter(const PendingClouds::Item& item) {
  auto points = pointsFromMsg(*item.cloud);
  if (!points.value)
    return report("cloud content", "a cloud in frame '" + item.cloud->header.frame_id + "' " +
                                       points.problem + ": check the sensor driver");
  Scan scan;
  scan.points = filtered(std::move(*points.value), cloud_params_);
  const std::string frame = withoutPrefix(params_.frame_prefix, item.cloud->header.frame_id);
  core_.with([&](MissionCore& c) {
    scan.T_world_sensor =
        frameAt(c, item.T_world_sensor.translation()).toLocal(item.T_world_sensor);
    for (const SensorModel& sensor : c.mission.robot().sensor_models)
      if (sensor.name == frame) scan.sensor = sensor.name;
    sensors_.heard(frame, missionTime(c, ::ros::Time::now()));
    scan.stamp_s = c.clock.toMission(item.cloud->header.stamp);
    const map::MapUpdate update = c.mission.onScan(scan);
    if (update.dropped_far > 0)
      c.watch.report("map range", map::beyondKeysText(update, c.mission.map().params()),
                     missionTime(c, ::ros::Time::now()));
  });
}

std::string PlannerInputs::stampProblem(const ::ros::Time& stamp, const ::ros::Time& now) const {
  const double age_s = (now - stamp).toSec();
  if (age_s < -cloud_params_.future_max_s)
    return "is stamped in the future: synchronise the clocks, and check use_sim_time";
  if (age_s > cloud_params_.age_max_s)
    return "is stamped long ago: synchronise the clocks, and check use_sim_time";
  return "";
}

void PlannerInputs::onOdometry(const nav_msgs::Odometry::ConstPtr& odometry) {
  holdingOnError(core_, "odometry", [&] {
    forgetAfterClockJump();
    const ::ros::Time now = ::ros::Time::now();
    if (now.isZero()) return;
    core_.with([&](MissionCore& c) { c.watch.heard(odometry_input_, missionTime(c, now)); });
    const std::string stamp_problem = stampProblem(odometry->header.stamp, now);
    if (!stamp_problem.empty()) return report("odometry stamp", "odometry " + stamp_problem);
    const std::string& frame = odometry->header.frame_id;
    const auto T_world_frame = findTransform(frame, ::ros::Time(0));  // The newest one there is.
    if (!T_world_frame.value)
      return report("odometry frame", "odometry is in frame '" + frame +
                                          "', which tf cannot bring into '" + params_.world_frame +
                                          "' (" + T_world_frame.problem +
                                          "): publish that transform");
    auto state = fromMsg(*odometry, *T_world_frame.value);
    if (!state.value)
      return report("odometry content",
                    "odometry " + state.problem + ": check the state estimator");
    core_.with([&](MissionCore& c) {
      state.value->stamp_s = c.clock.toMission(odometry->header.stamp);
      c.robot = frameAt(c, state.value->pose.position).toLocal(*state.value);
      c.mission.onOdometry(*c.robot);
    });
  });
}

void PlannerInputs::onBattery(const sensor_msgs::BatteryState::ConstPtr& battery) {
  holdingOnError(core_, "battery", [&] {
    const auto remaining_s = remainingFromMsg(*battery, endurance_s_);
    if (!remaining_s.value)
      return report("battery", "a battery message " + remaining_s.problem +
                                   ": check its driver; the time budget counts meanwhile");
    core_.with([&](MissionCore& c) {
      c.endurance.onBattery(*remaining_s.value, missionTime(c, ::ros::Time::now()));
    });
  });
}

}  // namespace spelunk::bridge
