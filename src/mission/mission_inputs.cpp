#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mission_impl.h"
#include "spelunk/common/stopwatch.h"

namespace spelunk::mission {
namespace {

constexpr double kTrailSpacing_m = 1.0;
constexpr double kScanFuture_s = 1.0;
constexpr double kFallenTilt_deg = 50.0;  // no slope that a robot walks on tilts it so far
constexpr double kFallenTime_s = 0.3;

bool isFinitePose(const Eigen::Isometry3d& pose) { return pose.matrix().allFinite(); }

}  // namespace

void Mission::Impl::takeOdometry(const RobotState& base) {
  RobotState report = base;
  report.pose.position.z() += robot.box_lift_m;
  const auto fault = input.check(report);
  if (fault) {
    input_fault = fault;
    say(LogLevel::kWarn, "odometry", *fault);
    return;
  }
  if (!input_fault && last_odometry_s) status.distance_m += distance(last_pose, report.pose);
  last_pose = report.pose;
  input_fault.reset();
  last_odometry_s = std::max(now, report.stamp_s);
  T_world_base = Eigen::Translation3d(base.pose.position) * base.orientation;
  watchForFall(base);
  if (!home_graph) return;
  const Pose& pose = report.pose;
  const std::size_t before = home_graph->trail().size();
  home_graph->addTrail(pose);
  if (home_graph->trail().size() != before) map.markFree(boxAround(pose.position, robot.box_m));
  if (stamped_trail.empty() || distance(stamped_trail.back().pose, pose) >= kTrailSpacing_m)
    stamped_trail.push_back({report.stamp_s, pose});
}

/// Told by the tilt alone: a robot that lies on its side for some time is not walking any more.
void Mission::Impl::watchForFall(const RobotState& base) {
  if (!terrain) return;
  const double upright = (base.orientation * Eigen::Vector3d::UnitZ()).z();
  if (upright > std::cos(kFallenTilt_deg * M_PI / 180.0)) return tilted_since_s.reset();
  if (!tilted_since_s) tilted_since_s = base.stamp_s;
  const bool lies = base.stamp_s - *tilted_since_s >= kFallenTime_s;
  if (!lies || state == MissionState::kEStop || !isFlying()) return;
  char why[120];
  std::snprintf(why, sizeof why, "the robot has fallen (tilted by %.0f degrees): help it up",
                std::acos(std::clamp(upright, -1.0, 1.0)) * 180.0 / M_PI);
  stopAtOnce(why);
}

std::optional<std::string> Mission::Impl::faultOf(const Scan& scan) const {
  if (!std::isfinite(scan.stamp_s) || !isFinitePose(scan.T_world_sensor))
    return "a scan's stamp or pose is not finite: check tf";
  if (scan.stamp_s > now + kScanFuture_s && last_scan_s)
    return "a scan's stamp lies in the future: check the clocks";
  if (scan.points.empty()) return "a scan without points: check the sensor";
  return std::nullopt;
}

/// Scans of sensors the robot's description does not name are all mapped.
ScanThinning& Mission::Impl::thinningOf(const std::string& sensor) {
  double period_s = 0.0;
  for (const SensorModel& model : robot.sensor_models)
    if (model.name == sensor) period_s = model.mapping_period_s;
  return thinnings.try_emplace(sensor, period_s).first->second;
}

map::MapUpdate Mission::Impl::takeScan(const Scan& scan) {
  if (const auto fault = faultOf(scan)) {
    say(LogLevel::kWarn, "scan", *fault);
    return {};
  }
  last_scan_s = std::max(now, scan.stamp_s);
  if (!thinningOf(scan.sensor).takes(scan.stamp_s)) return {};
  const Stopwatch watch;
  const Eigen::Vector3d centre =
      input.latest() ? input.latest()->pose.position : scan.T_world_sensor.translation();
  map::MapUpdate update = map.insert(scan, boxAround(centre, kBodyShare * robot.box_m));
  noteGround(scan);
  status.last_map_update_ms = watch.milliseconds();
  newest_scan_s = std::max(newest_scan_s, scan.stamp_s);
  ++scans;
  if (update.newly_occupied.empty()) return update;
  if (home_graph) home_graph->noteOccupied(update.newly_occupied);
  if (active) active->noteOccupied(update.newly_occupied, now);
  if (go_to && go_to->monitor && go_to->monitor->firstHit(update.newly_occupied))
    go_to->is_suspect = true;
  if (route && route->monitor.firstHit(update.newly_occupied)) {
    route.reset();
    next_refresh_s = now;
  }
  return update;
}

void Mission::Impl::takeRemaining(double remaining) {
  if (!std::isfinite(remaining) || remaining < 0.0) {
    say(LogLevel::kWarn, "battery", "the reported endurance is not a number: it is not used");
    return;
  }
  reported_remaining_s = remaining;
}

std::string Mission::Impl::startProblem() {
  if (!input.latest()) return "no odometry yet: check the topic and the state estimation";
  if (tilted_since_s) return "the robot lies on its side: help it up";
  const Eigen::Vector3d& position = input.latest()->pose.position;
  if (!limits.contains(position))
    return "the robot stands outside the bounds: widen them or move it";
  for (const NoGoZone& zone : no_go)
    if (sweptBoxMeets(zone, position, position, robot.box_m))
      return "the robot stands in no-go zone '" + zone.name + "': remove it or move the robot";
  const auto view = map.freeze();
  bool collides = false;
  const Eigen::Vector3d body =
      kBodyShare * robot.box_m + Eigen::Vector3d::Constant(view->resolution());  // touched voxels
  view->forEachOccupied(boxAround(position, body),
                        [&](const map::VoxelIndex&) { collides = true; });
  if (collides) return "start in collision: the map is occupied where the robot stands";
  return "";
}

void Mission::Impl::markStandFree() {
  const Eigen::Vector3d& position = input.latest()->pose.position;
  const Eigen::Vector3d room = params.start_clearance_m * Eigen::Vector3d(1.0, 1.0, 0.5);
  AxisAlignedBox stand = boxAround(position, robot.box_m + 2.0 * room);
  if (terrain) stand.min.z() = position.z() - 0.5 * robot.box_m.z();  // below it there is ground
  map.markFree(stand);
}

void Mission::Impl::takeOff() {
  const Pose pose = input.latest()->pose;
  if (!home_graph) {
    home_graph.emplace(pose, robot.box_m, map.params().resolution_m, footingCheck());
    markStandFree();
    if (terrain) terrain->assumeGroundUnder(T_world_base);
    stamped_trail.push_back({input.latest()->stamp_s, pose});
  }
  if (started_s) return;
  started_s = now;
  if (isAtHome()) endurance_at_start_s = robot.endurance_s;  // one at home can be recharged
}

Answer Mission::Impl::start() {
  const std::string problem = startProblem();
  if (!problem.empty()) {
    status.reason = problem;
    return {false, problem};
  }
  takeOff();
  goal = Goal::kExplore;
  failures = 0;
  next_ask_s = now;
  status.end_reason.clear();
  enter(MissionState::kExplore, "started");
  return {true, "exploring"};
}

Answer Mission::Impl::pause() {
  if (!isFlying()) return {false, "nothing to pause: the mission is not running"};
  goal = Goal::kNone;
  hold("paused: start takes up the mission again", planners::PathOutcome::kReplaced);
  return {true, "holding until start"};
}

Answer Mission::Impl::goHomeAsAsked() {
  if (!home_graph) return {false, "there is no home yet: start the mission first"};
  if (state == MissionState::kEStop) return {false, "emergency stop is on: start releases it"};
  goHome("home as asked", HomeCause::kOther);
  return {true, "going home"};
}

Answer Mission::Impl::emergencyStop() {
  stopAtOnce("emergency stop: start releases it");
  return {true, "stopped"};
}

void Mission::Impl::stopAtOnce(const std::string& why) {
  goal = Goal::kNone;
  active.reset();
  pending.reset();
  running.reset();
  backs_off = false;
  command = Command{};
  enter(MissionState::kEStop, why);
}

MissionRecord Mission::Impl::record(const planners::PlannerGraph& graph) const {
  MissionRecord record;
  record.bounds = limits;
  record.given_zones = given_zones;
  record.marked_zones = markedZones();
  if (home_graph) record.trail = home_graph->trail();
  record.remaining_s = guard.remaining();
  record.graph = graph;
  return record;
}

void Mission::Impl::takeUp(const MissionRecord& record) {
  limits = record.bounds;
  no_go = given_zones = record.given_zones;
  no_go.insert(no_go.end(), record.marked_zones.begin(), record.marked_zones.end());
  status.zones_marked = static_cast<int>(record.marked_zones.size());
  if (record.trail.empty()) return;
  endurance_at_start_s = std::min(robot.endurance_s, record.remaining_s);
  started_s.reset();
  home_graph.emplace(record.trail.front(), robot.box_m, map.params().resolution_m, footingCheck());
  for (const Pose& pose : record.trail) home_graph->addTrail(pose);
  for (const NoGoZone& zone : record.marked_zones) home_graph->noteZone(zone);
}

std::vector<NoGoZone> Mission::Impl::markedZones() const {
  return {no_go.begin() + static_cast<long>(given_zones.size()), no_go.end()};
}

Answer Mission::Impl::setBounds(const AxisAlignedBox& box) {
  if (box.isEmpty() || box.min.hasNaN() || box.max.hasNaN())
    return {false, "the bounds are empty: min must lie below max on each axis"};
  if (input.latest() && !box.contains(input.latest()->pose.position))
    return {false, "the bounds exclude the robot: choose them around it"};
  limits = box;
  if (active && active->kind() != planners::PathKind::kHome) next_ask_s = now;
  return {true, "bounds set"};
}

Answer Mission::Impl::setZones(std::vector<NoGoZone> list) {
  for (const NoGoZone& zone : list) {
    if (zone.polygon.size() < 3)
      return {false, "no-go zone '" + zone.name + "' needs at least three corners"};
    if (!(zone.z_min < zone.z_max))
      return {false, "no-go zone '" + zone.name + "': z_min must lie below z_max"};
    if (input.latest() && sweptBoxMeets(zone, input.latest()->pose.position,
                                        input.latest()->pose.position, robot.box_m))
      return {false, "no-go zone '" + zone.name + "' holds the robot: move it out first"};
  }
  const std::vector<NoGoZone> marked = markedZones();
  given_zones = std::move(list);
  no_go = given_zones;
  no_go.insert(no_go.end(), marked.begin(), marked.end());
  return {true, std::to_string(given_zones.size()) + " no-go zone(s) set"};
}

}  // namespace spelunk::mission
