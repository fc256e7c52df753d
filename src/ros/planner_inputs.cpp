#include "spelunk/ros/planner_inputs.h"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "spelunk/mission/robot_watch.h"
#include "spelunk/ros/convert.h"
#include "spelunk/ros/frame_names.h"
#include "spelunk/ros/ros_log.h"
#include "spelunk/ros/stamp_check.h"

namespace spelunk::bridge {
namespace {

constexpr double kTimerPeriod_s = 0.02;
constexpr std::uint32_t kCloudQueue = 5;
constexpr std::uint32_t kOdometryQueue = 50;
constexpr double kOvertaken_s = 0.5;  // no network holds one message back for longer
constexpr int kLateInARow = 5;        // more than a network does
constexpr double kTfMoved_m = 0.05;   // of its own accord tf moves the odometry's frame less
constexpr double kBlur = 0.1;         // of a voxel: less does no harm

}  // namespace

PlannerInputs::PlannerInputs(const ::ros::NodeHandle& node, const PlannerNodeParams& params,
                             const CloudParams& cloud_params, GuardedCore& core)
    : params_(params),
      cloud_params_(cloud_params),
      core_(core),
      endurance_s_(core.with([](MissionCore& c) { return c.mission.robot().endurance_s; })),
      resolution_m_(
          core.with([](MissionCore& c) { return c.mission.map().params().resolution_m; })),
      pending_(cloud_params),
      sensors_(core.with([](MissionCore& c) { return c.mission.robot(); }), params.silence_s),
      places_(core.with([](MissionCore& c) { return c.mission.robot(); }), params.world_frame,
              resolution_m_, cloud_params.registered_sensor, tree(), params.frame_prefix),
      self_returns_(core.with([](MissionCore& c) { return c.mission.robot(); }),
                    core.with([](MissionCore& c) { return c.mission.map().params().range_min_m; })),
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
  expectInputs();
  spinner_.start();
}

PlannerInputs::~PlannerInputs() { spinner_.stop(); }

void PlannerInputs::expectInputs() {
  const auto publishersOf = [](const ::ros::Subscriber& subscriber) {
    return [subscriber] { return subscriber.getNumPublishers(); };
  };
  core_.with([&](MissionCore& c) {
    const double now_s = missionTime(c, ::ros::Time::now());
    const double scan_silence_s =
        std::max(params_.silence_s, mission::scanSilence(c.mission.robot()));
    odometry_input_ = c.watch.expect({"odometry", node_.resolveName("odometry"), "odometry",
                                      params_.silence_s, publishersOf(odometry_subscriber_), 1},
                                     now_s);
    cloud_input_ = c.watch.expect({"point clouds", node_.resolveName("pointcloud"), "pointcloud",
                                   scan_silence_s, publishersOf(cloud_subscriber_), 0},
                                  now_s);
  });
}

void PlannerInputs::report(const std::string& key, const std::string& text) {
  core_.with(
      [&](MissionCore& c) { c.watch.report(key, text, missionTime(c, ::ros::Time::now())); });
}

void PlannerInputs::reportCloud(const std::string& key, const std::string& text) {
  core_.with([&](MissionCore& c) {
    c.watch.report(cloud_input_, key, text, missionTime(c, ::ros::Time::now()));
  });
}

void PlannerInputs::reportOdometry(const std::string& key, const std::string& text) {
  core_.with([&](MissionCore& c) {
    c.watch.report(odometry_input_, key, text, missionTime(c, ::ros::Time::now()));
  });
}

void PlannerInputs::forgetAfterClockJump() {
  const auto jumps = core_.with([](MissionCore& c) {
    missionTime(c, ::ros::Time::now());
    return c.clock_jumps;
  });
  if (jumps == jumps_seen_) return;
  jumps_seen_ = jumps;
  first_used_.reset();
  first_given_up_.reset();
  newest_odometry_ = ::ros::Time();
  places_.forget();
  self_returns_.forget();
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
  } catch (const tf2::ExtrapolationException& error) {
    return {std::nullopt, "tf brings it into '" + params_.world_frame + "' at other times only (" +
                              error.what() +
                              "): let tf come in time and as often as clouds, stamped by the same "
                              "clock, or raise cloud/tf_wait_s"};
  } catch (const tf2::TransformException& error) {
    return {std::nullopt, "tf cannot bring it into '" + params_.world_frame + "' (" + error.what() +
                              "): publish the transforms between '" + params_.world_frame +
                              "' and '" + frame +
                              "' on tf, or set world_frame to a frame above it"};
  }
}

/// Odometry knows no corrections: what the robot carries is where tf has it in the odometry's
/// frame, and that is where the newest odometry had it in the world. Between two transforms of a
/// SLAM with a correction between them tf has places where the robot never was.
FromMsg<Eigen::Isometry3d> PlannerInputs::findByOdometry(const std::string& frame,
                                                         const ::ros::Time& stamp) const {
  if (!odometry_frame_.empty() && odometry_frame_ != params_.world_frame) {
    try {
      const Eigen::Isometry3d T =
          tf2::transformToEigen(tf_buffer_.lookupTransform(odometry_frame_, frame, stamp));
      if (T.matrix().allFinite()) return {T_world_odometry_ * T, ""};
    } catch (const tf2::TransformException&) {
      // By way of the world, or what is missing there.
    }
  }
  return findTransform(frame, stamp);
}

bool PlannerInputs::hasTransform(const std::string& frame) const {
  return findTransform(frame, ::ros::Time(0)).value.has_value();
}

FrameTree PlannerInputs::tree() const {
  return {[this](const std::string& frame, const ::ros::Time& stamp) {
            return findByOdometry(frame, stamp);
          },
          [this](const std::string& frame) -> std::optional<std::string> {
            std::string parent;
            if (!tf_buffer_._getParent(frame, ::ros::Time(0), parent)) return std::nullopt;
            return parent;
          }};
}

void PlannerInputs::onCloud(const sensor_msgs::PointCloud2::ConstPtr& cloud) {
  holdingOnError(core_, "pointcloud", [&] {
    forgetAfterClockJump();
    const ::ros::Time now = ::ros::Time::now();
    if (now.isZero()) return;  // Simulated time has not begun.
    core_.with([&](MissionCore& c) { c.watch.heard(cloud_input_, missionTime(c, now)); });
    const std::string problem = pending_.push(cloud, now);
    if (!problem.empty()) reportCloud("cloud stamp or frame", problem);
    enterReadyClouds(now);
  });
}

void PlannerInputs::onTimer() {
  holdingOnError(core_, "waiting clouds", [&] {
    forgetAfterClockJump();
    enterReadyClouds(::ros::Time::now());
    sayWhichSensorsAreMissing();
  });
}

void PlannerInputs::reportSenders(TfInput::SentByTwo what, const std::string& text) {
  core_.with([&](MissionCore& c) {
    if (what == TfInput::SentByTwo::kClock) c.has_two_clocks = true;
    c.watch.report(text, text, missionTime(c, ::ros::Time::now()));
  });
}

void PlannerInputs::sayWhichSensorsAreMissing() {
  core_.with([&](MissionCore& c) {
    const double now_s = missionTime(c, ::ros::Time::now());
    for (const std::string& text : sensors_.news(now_s)) c.watch.report(text, text, now_s);
  });
}

void PlannerInputs::enterReadyClouds(const ::ros::Time& now) {
  const auto lookup = [this](const std::string& frame, const ::ros::Time& stamp) {
    return places_.find(frame, stamp);
  };
  for (const PendingClouds::Item& item : pending_.take(lookup, now)) {
    if (item.problem.empty()) {
      enter(item);
    } else {
      giveUp(item, now);
    }
  }
  for (const std::string& text : places_.news()) log(LogLevel::kInfo, text);
}

/// The first clouds may be older than the first transform: they are dropped without a word.
void PlannerInputs::giveUp(const PendingClouds::Item& item, const ::ros::Time& now) {
  if (!first_given_up_) first_given_up_ = now;
  const bool is_beginning = first_used_
                                ? item.cloud->header.stamp < *first_used_
                                : (now - *first_given_up_).toSec() < cloud_params_.tf_wait_s;
  if (!is_beginning || !hasTransform(frameName(item.cloud->header.frame_id)))
    reportCloud("cloud transform", item.problem);
}

void PlannerInputs::enter(const PendingClouds::Item& item) {
  const std::string frame = frameName(item.cloud->header.frame_id);
  const CloudPlace& place = item.place;
  auto points = pointsFromMsg(*item.cloud, place.T_sensor_cloud);
  if (!points.value)
    return reportCloud("cloud content", "a cloud in frame '" + frame + "' " + points.problem);
  if (!first_used_) first_used_ = item.cloud->header.stamp;
  sayIfCoarse(*item.cloud, place);
  const std::string name =
      place.sensor.empty() ? withoutPrefix(params_.frame_prefix, frame) : place.sensor;
  Scan scan;
  scan.sensor = place.sensor;
  scan.points = self_returns_.without(name, filtered(std::move(*points.value), cloud_params_),
                                      place.T_base_sensor,
                                      place.T_world_sensor * place.T_base_sensor.inverse());
  core_.with([&](MissionCore& c) {
    const double now_s = missionTime(c, ::ros::Time::now());
    sensors_.heard(name, now_s);
    c.watch.used(cloud_input_, now_s);
    c.doubt = self_returns_.doubt();
    c.flaw = self_returns_.finding();
    if (!c.flaw.empty()) c.watch.report("self returns", c.flaw, now_s);
    (void)frameAt(c, place.T_world_sensor.translation());
    scan.stamp_s = c.clock.toMission(item.cloud->header.stamp);
    const auto then = c.steady.at(scan.stamp_s);
    if (!then) return;
    scan.T_world_sensor = then->toLocal(place.T_world_sensor);
    const map::MapUpdate update = c.mission.onScan(scan);
    if (update.dropped_far > 0)
      c.watch.report("map range", map::beyondKeysText(update, c.mission.map().params()), now_s);
  });
}

/// Registered clouds far from the origin of their frame: numbers of 32 bits blur the walls there.
void PlannerInputs::sayIfCoarse(const sensor_msgs::PointCloud2& cloud, const CloudPlace& place) {
  const double error_m =
      coordinateError(cloud, place.T_sensor_cloud.inverse().translation().cwiseAbs().maxCoeff());
  if (error_m < kBlur * resolution_m_) return;
  char text[40];
  std::snprintf(text, sizeof(text), "%.3g m", error_m);
  reportCloud("cloud precision",
              "a cloud in frame '" + frameName(cloud.header.frame_id) + "' is only exact to " +
                  text +
                  ": it has 32-bit numbers far from the origin of its frame; remap 'pointcloud' to "
                  "the cloud in the sensor's frame, or let x, y and z be sent as FLOAT64");
}

/// A message that was overtaken by newer ones tells nothing new.
bool PlannerInputs::comesTooLate(const ::ros::Time& stamp) {
  const double behind_s = (newest_odometry_ - stamp).toSec();
  if (behind_s <= 0.0 || behind_s > kOvertaken_s) {
    newest_odometry_ = stamp;
    late_odometry_ = 0;
    return false;
  }
  if (++late_odometry_ >= kLateInARow) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.3f s", behind_s);
    reportOdometry("odometry order",
                   "odometry is stamped " + std::string(text) +
                       " before odometry that came earlier, again and again: stop the second "
                       "publisher on that topic, or let its driver stamp and send in order");
  }
  return true;
}

void PlannerInputs::onOdometry(const nav_msgs::Odometry::ConstPtr& odometry) {
  holdingOnError(core_, "odometry", [&] {
    forgetAfterClockJump();
    const ::ros::Time now = ::ros::Time::now();
    if (now.isZero()) return;
    core_.with([&](MissionCore& c) { c.watch.heard(odometry_input_, missionTime(c, now)); });
    const std::string stamp_problem = stampProblem(odometry->header.stamp, now, cloud_params_);
    if (!stamp_problem.empty())
      return reportOdometry("odometry stamp", "odometry " + stamp_problem);
    if (comesTooLate(odometry->header.stamp)) return;
    const std::string frame = frameName(odometry->header.frame_id);
    if (frame.empty())
      return reportOdometry("odometry frame",
                            "odometry has no frame_id: set the frame of its poses in the state "
                            "estimator (header.frame_id), and the base's in child_frame_id");
    const auto T_world_frame = findTransform(frame, ::ros::Time(0));  // The newest one there is.
    if (!T_world_frame.value)
      return reportOdometry("odometry frame",
                            "odometry is in frame '" + frame + "', " + T_world_frame.problem);
    auto state = fromMsg(*odometry, *T_world_frame.value);
    if (!state.value)
      return reportOdometry("odometry content",
                            "odometry " + state.problem + ": check the state estimator");
    std::string base_frame = frameName(odometry->child_frame_id);
    if (const auto T_child_base = findBaseIn(base_frame)) {
      state.value = ofBase(*state.value, *T_child_base);
      base_frame = prefixed(params_.frame_prefix, params_.base_frame);
    }
    takeOver(*odometry, base_frame, *state.value, *T_world_frame.value);
  });
}

/// Where tf has the base against the frame that odometry is of; none if that is the base, or if tf
/// does not know: then it is taken for the base.
std::optional<Eigen::Isometry3d> PlannerInputs::findBaseIn(const std::string& child) {
  const std::string base = prefixed(params_.frame_prefix, params_.base_frame);
  if (child.empty() || child == base) return std::nullopt;
  try {
    const Eigen::Isometry3d T =
        tf2::transformToEigen(tf_buffer_.lookupTransform(child, base, ::ros::Time(0)));
    if (!T.matrix().allFinite()) return std::nullopt;
    if (std::exchange(said_child_, child) != child)
      log(LogLevel::kInfo, "odometry is of the frame '" + child + "': the robot's base '" + base +
                               "' is found from it by tf");
    return T;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

void PlannerInputs::takeOver(const nav_msgs::Odometry& odometry, const std::string& base_frame,
                             const RobotState& state, const Eigen::Isometry3d& T_world_frame) {
  odometry_frame_ = frameName(odometry.header.frame_id);
  const Eigen::Isometry3d before = std::exchange(T_world_odometry_, T_world_frame);
  const Eigen::Isometry3d T_world_base =
      Eigen::Translation3d(state.pose.position) * state.orientation;
  places_.onOdometry(odometry_frame_, base_frame, odometry.header.stamp.toSec(), T_world_base);
  core_.with([&](MissionCore& c) {
    RobotState report = state;
    report.stamp_s = c.clock.toMission(odometry.header.stamp);
    (void)frameAt(c, state.pose.position);
    if (const auto correction = c.steady.take(report)) {
      log(LogLevel::kInfo, *correction);
      c.frame = c.steady.now();
      logToRos(c.frame);
      c.was_corrected = true;
      const bool is_by_tf = distance(poseOf(before), poseOf(T_world_frame)) > kTfMoved_m;
      if (is_by_tf) c.steady.forgetPast();  // all is looked up by way of tf as it is now
      if (is_by_tf) places_.correct(c.steady.correction());
    }
    const RobotState timed = c.frame.toLocal(report);
    c.robot = timed;
    c.watch.used(odometry_input_, missionTime(c, ::ros::Time::now()));
    c.mission.onOdometry(timed);
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
