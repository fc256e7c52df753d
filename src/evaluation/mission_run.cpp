#include "spelunk/evaluation/mission_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mail.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/common/self_returns.h"
#include "spelunk/common/stopwatch.h"
#include "spelunk/mission/mission_frame.h"
#include "spelunk/mission/moved_mission.h"

namespace spelunk::evaluation {
namespace {

constexpr int kTicksPerSecond = 10;
constexpr int kWarmUpTicks = 5;  // scans before the mission is started
constexpr double kClearanceLimit_m = 5.0;
constexpr double kRateWindow_s = 10.0;
constexpr double kOutOfEndurance_s = 0.05;
constexpr double kStandstill_mps = 0.1;
constexpr double kSaidAgain_s = 60.0;
constexpr double kInTime_s = 1e-6;

/// Where rays that meet nothing are reported, they make free space, and outside an open mesh that
/// never ends: such a robot stays within the mesh. Others see no way out of it.
AxisAlignedBox boundsOf(const RunSetup& setup, const sim::WorldMesh& mesh) {
  const auto& sensors = setup.robot.sensor_models;
  const bool sees_the_open =
      std::any_of(sensors.begin(), sensors.end(),
                  [](const SensorModel& sensor) { return sensor.reports_misses; });
  if (!sees_the_open) return setup.bounds;
  const AxisAlignedBox start = boxAround(setup.start.position, setup.robot.box_m);
  return intersection(setup.bounds, hull(mesh.bounds(), start));
}

}  // namespace

struct MissionRun::Impl {
  Impl(const RunSetup& run_setup, const sim::WorldMesh& mesh,
       planners::ExplorationPlanner& run_planner)
      : setup(run_setup),
        planner(run_planner),
        mesh_frame(mesh.frame),
        simulator(setup.sim, setup.robot, mesh, setup.start, setup.seed),
        mission(setup.mission, setup.robot, setup.map, setup.seed, setup.terrain),
        frame(setup.robot, setup.map.resolution_m),
        promise(mission, simulator.scene(), simulator.bodySize()),
        bounds(boundsOf(run_setup, mesh)),
        self_returns(setup.robot, setup.map.range_min_m),
        reachable(reachableSpace(mesh, setup.start.position)),
        explored(mesh.bounds()),
        scans(setup.delays.scan_s),
        outcomes(setup.delays.plan_s),
        losses(Rng(setup.seed).fork("run/lost scans")) {
    simulator.castOnlyMappedScans();
    record.min_clearance_m = kClearanceLimit_m;
    last_position = simulator.trueState().pose.position;
  }

  RunRecord fly(const std::function<void(const Progress&)>& show);
  void warmUp();
  void begin();
  void nextLeg();
  void noteLeg();
  void step();
  void sense();
  void enter(Scan scan);
  [[nodiscard]] bool isOdometryDue();
  void takeOutSelfReturns(Scan& scan);
  void plan();
  void takeOver();
  void watchPromise();
  [[nodiscard]] bool getsLost();
  void measure();
  void follow(const std::optional<mission::Command>& command);
  void addTimelineRow();
  [[nodiscard]] bool isOver() const;
  [[nodiscard]] bool hasReachedAllLegs() const;
  [[nodiscard]] bool isHolding() const;
  [[nodiscard]] bool areLegsDone() const;
  void finish();
  void finishLegs();
  [[nodiscard]] double now() const { return static_cast<double>(ticks) / kTicksPerSecond; }
  [[nodiscard]] double remaining() const;
  [[nodiscard]] Progress progress() const;

  RunSetup setup;
  planners::ExplorationPlanner& planner;
  LocalFrame mesh_frame;
  sim::Simulator simulator;
  mission::Mission mission;
  mission::MissionFrame frame;  ///< Its caller's frame is that of the simulated odometry.
  PromiseWatch promise;
  AxisAlignedBox bounds;  ///< Of exploration.
  SelfReturns self_returns;
  ReachableSpace reachable;
  ExploredVolume explored;
  Mail<Scan> scans;
  Mail<mission::PlanOutcome> outcomes;
  Rng losses;
  Throttle said{kSaidAgain_s};
  RunRecord record;
  std::int64_t ticks = 0;
  double started_s = 0.0;
  double next_odometry_s = 0.0;
  Eigen::Vector3d last_position = Eigen::Vector3d::Zero();
  bool is_underway = false;  ///< To the point of the newest leg.
  std::string stopped_why;   ///< Not empty: somebody ended the flight.
};

double MissionRun::Impl::remaining() const {
  const double by_time = setup.time_limit_s - (now() - started_s);
  return std::max(0.0, std::min(by_time, simulator.battery().remaining_s));
}

void MissionRun::Impl::sense() {
  for (const sim::SimulatedScan& scan : simulator.advanceTo(now())) {
    explored.add(scan);
    if (!getsLost()) scans.send(scan.scan, now());
  }
  const RobotState report = simulator.odometry();
  const bool is_due = isOdometryDue();
  const auto correction = is_due ? frame.take(report) : std::nullopt;
  for (Scan& scan : scans.take(now())) enter(std::move(scan));
  if (is_due) mission.onOdometry(frame.now().toLocal(report));
  mission.onRemaining(remaining());
  if (!correction) return;
  log(LogLevel::kInfo, *correction);
  follow(mission.commandAgain(now()));
}

bool MissionRun::Impl::isOdometryDue() {
  if (now() + kInTime_s < next_odometry_s) return false;
  next_odometry_s = now() + setup.delays.odometry_period_s;
  return true;
}

void MissionRun::Impl::enter(Scan scan) {
  const auto then = frame.at(scan.stamp_s);
  if (!then) return;
  takeOutSelfReturns(scan);
  scan.T_world_sensor = then->toLocal(scan.T_world_sensor);
  const map::MapUpdate update = mission.onScan(scan);
  if (update.dropped_far > 0 && said.allows("map range", now()))
    log(LogLevel::kWarn, map::beyondKeysText(update, setup.map));
  record.map_update_ms.push_back(mission.status().last_map_update_ms);
}

void MissionRun::Impl::takeOutSelfReturns(Scan& scan) {
  for (const SensorModel& sensor : setup.robot.sensor_models) {
    if (sensor.name != scan.sensor) continue;
    const Eigen::Isometry3d mount = T_base_sensor(sensor);
    scan.points = self_returns.without(scan.sensor, std::move(scan.points), mount,
                                       scan.T_world_sensor * mount.inverse());
  }
  mission.noteInputs({"", self_returns.doubt(), self_returns.finding()});
}

bool MissionRun::Impl::getsLost() {
  return setup.delays.scan_loss > 0.0 && losses.uniform() < setup.delays.scan_loss;
}

void MissionRun::Impl::measure() {
  const Eigen::Vector3d position = simulator.trueState().pose.position;
  record.path_length_m += (position - last_position).norm();
  last_position = position;
  const double gap =
      simulator.scene().boxDistance(position, simulator.bodySize(), record.min_clearance_m);
  record.min_clearance_m = std::min(record.min_clearance_m, gap);
}

void MissionRun::Impl::follow(const std::optional<mission::Command>& command) {
  if (!command) return;
  simulator.follow(frame.now().toCaller(command->trajectory));
  simulator.take(command->posture);
}

/// One plan at a time, like a planner in a thread of its own.
void MissionRun::Impl::plan() {
  if (!outcomes.isEmpty()) return;
  const auto job = mission.takeJob();
  if (!job) return;
  const Stopwatch watch;
  mission::PlanOutcome outcome = mission::run(*job, planner);
  PlanRow row;
  row.wall_ms = watch.milliseconds();
  row.t_s = now();
  row.explore = mission::isExploration(*job);
  row.result = row.explore ? outcome.plan : outcome.home;
  row.length_m = lengthOf(row.result.path);
  row.result.path.clear();
  row.result.remaining.clear();
  record.plans.push_back(std::move(row));
  outcomes.send(std::move(outcome), now());
}

void MissionRun::Impl::takeOver() {
  for (const mission::PlanOutcome& outcome : outcomes.take(now())) {
    const auto command = mission.accept(outcome, now());
    const bool accepted = command && !command->path.empty();
    record.plans.back().verdict = accepted ? "accepted" : mission.status().reason;
    follow(command);
  }
}

void MissionRun::Impl::step() {
  ++ticks;
  sense();
  measure();
  takeOver();
  follow(mission.tick(now()));
  plan();
  takeOver();
  watchPromise();
  if (is_underway && mission.status().go_to.outcome != mission::GoToOutcome::kUnderway) noteLeg();
  const bool goes_on = !record.legs.empty() && !is_underway &&
                       record.legs.size() < setup.legs.size() && hasReachedAllLegs();
  if (goes_on && isHolding()) nextLeg();
  if (ticks % kTicksPerSecond == 0) addTimelineRow();
}

void MissionRun::Impl::watchPromise() {
  const bool drifts = setup.sim.odometry_drift > 0.0 || setup.sim.odometry_noise_m > 0.0;
  promise.look(now(), frame.now().toLocal(simulator.odometry().pose),
               simulator.trueState().velocity.norm(),
               drifts ? PromiseWatch::Paths::kUnknownInTruth : PromiseWatch::Paths::kComparable);
}

void MissionRun::Impl::warmUp() {
  for (int k = 0; k < kWarmUpTicks; ++k) {
    ++ticks;
    sense();
    mission.tick(now());
  }
  if (const auto answer = mission.setBounds(bounds); !answer.accepted)
    throw OutsideError("the bounds are refused: " + answer.reason);
  if (const auto answer = mission.setZones(setup.zones); !answer.accepted)
    throw OutsideError("the no-go zones are refused: " + answer.reason);
  started_s = now();
}

void MissionRun::Impl::begin() {
  if (!setup.legs.empty()) return nextLeg();
  if (const auto answer = mission.start(); !answer.accepted)
    throw OutsideError("the mission does not start: " + mesh_frame.toCaller(answer.reason));
}

/// Sends the robot to the next point. A refusal ends the run as a leg that was not reached.
void MissionRun::Impl::nextLeg() {
  const GoToLeg& leg = setup.legs[record.legs.size()];
  GoToRecord begun;
  begun.leg = leg;
  begun.path_length_m = -record.path_length_m;
  const mission::Answer given = mission.goTo(frame.now().toLocal(leg.target), leg.navigation);
  if (!given.accepted) {
    begun.status.outcome = mission::GoToOutcome::kUnreachable;
    begun.status.reason = given.reason;
  }
  record.legs.push_back(begun);
  is_underway = given.accepted;
  if (!is_underway) noteLeg();
}

/// Closes the newest leg.
void MissionRun::Impl::noteLeg() {
  GoToRecord& leg = record.legs.back();
  if (is_underway) leg.status = mission.status().go_to;
  is_underway = false;
  leg.path_length_m += record.path_length_m;
  leg.execution_s = leg.status.ended_s - leg.status.started_s;
  leg.final_distance_m = (simulator.trueState().pose.position - leg.leg.target).norm();
}

void MissionRun::Impl::addTimelineRow() {
  const Pose pose = simulator.trueState().pose;
  const double clearance_m =
      simulator.scene().boxDistance(pose.position, simulator.bodySize(), kClearanceLimit_m);
  record.timeline.push_back({now(), explored.partedBy(reachable).inside_m3, record.path_length_m,
                             pose, remaining(), mission.status().state, clearance_m});
}

Progress MissionRun::Impl::progress() const {
  Progress shown;
  shown.t_s = now();
  shown.status = mission.status();
  if (record.timeline.empty()) return shown;
  const TimelineRow& last = record.timeline.back();
  const auto window = static_cast<std::size_t>(kRateWindow_s);
  const std::size_t before =
      record.timeline.size() > window ? record.timeline.size() - 1 - window : 0;
  const TimelineRow& first = record.timeline[before];
  shown.explored_m3 = last.explored_m3;
  if (last.t_s > first.t_s)
    shown.rate_m3ps = (last.explored_m3 - first.explored_m3) / (last.t_s - first.t_s);
  return shown;
}

bool MissionRun::Impl::hasReachedAllLegs() const {
  return std::all_of(record.legs.begin(), record.legs.end(), [](const GoToRecord& leg) {
    return leg.status.outcome == mission::GoToOutcome::kReached;
  });
}

/// At a standstill: the next leg may begin.
bool MissionRun::Impl::isHolding() const {
  return simulator.trueState().velocity.norm() < kStandstill_mps;
}

bool MissionRun::Impl::areLegsDone() const {
  if (setup.legs.empty() || is_underway) return false;
  if (mission.status().state == mission::MissionState::kHome) return false;
  return !hasReachedAllLegs() || record.legs.size() == setup.legs.size();
}

bool MissionRun::Impl::isOver() const {
  return !stopped_why.empty() || areLegsDone() ||
         mission.status().state == mission::MissionState::kDone ||
         simulator.walkerCount().falls > 0 || remaining() <= kOutOfEndurance_s;
}

void MissionRun::Impl::finish() {
  const mission::MissionStatus status = mission.status();
  const Pose pose = simulator.trueState().pose;
  record.mission_time_s = now();
  const SeenVolume seen = explored.partedBy(reachable);
  record.explored_volume_m3 = seen.inside_m3;
  record.explored_outside_m3 = seen.outside_m3;
  record.reachable = volumeOf(reachable);
  record.collisions = simulator.collisions().episodes;
  record.collision_s = simulator.collisions().seconds;
  record.falls = simulator.walkerCount().falls;
  record.slips = simulator.walkerCount().slips;
  record.trips = simulator.walkerCount().trips;
  record.zones_marked = status.zones_marked;
  record.promise = promise.record();
  record.returned_home = status.state == mission::MissionState::kDone;
  record.remaining_at_home_s = record.returned_home ? remaining() : 0.0;
  record.ended_as_it_may = record.returned_home && remaining() > 0.0;
  record.remaining_targets = mission.remaining();
  if (is_underway) noteLeg();
  if (!stopped_why.empty() && !record.returned_home) {
    record.outcome =
        stopped_why + ", " + std::to_string(distance(pose, setup.start)) + " m from home";
    return;
  }
  if (!setup.legs.empty() && !record.returned_home) return finishLegs();
  record.outcome = record.returned_home ? status.end_reason
                                        : (record.falls > 0 ? "fell " : "stranded ") +
                                              std::to_string(distance(pose, setup.start)) +
                                              " m from home: " + status.reason;
}

void MissionRun::Impl::finishLegs() {
  const mission::GoToStatus& last = record.legs.back().status;
  const bool reached = hasReachedAllLegs() && record.legs.size() == setup.legs.size();
  record.ended_as_it_may = reached && record.falls == 0 && remaining() > kOutOfEndurance_s;
  record.outcome =
      reached ? "reached" : std::string(mission::toText(last.outcome)) + ": " + last.reason;
}

RunRecord MissionRun::Impl::fly(const std::function<void(const Progress&)>& show) {
  const Stopwatch watch;
  warmUp();
  begin();
  while (!isOver()) {
    step();
    if (show && ticks % kTicksPerSecond == 0) show(progress());
  }
  finish();
  record.wall_time_s = 1e-3 * watch.milliseconds();
  return std::move(record);
}

MissionRun::MissionRun(const RunSetup& setup, const sim::WorldMesh& mesh,
                       planners::ExplorationPlanner& planner)
    : impl_(new Impl(setup, mesh, planner)) {}
MissionRun::~MissionRun() = default;

RunRecord MissionRun::fly(const std::function<void(const Progress&)>& show) {
  return impl_->fly(show);
}

void MissionRun::stop(const std::string& why) { impl_->stopped_why = why; }
ReachableVolume MissionRun::reachable() const { return volumeOf(impl_->reachable); }

mission::Mission& MissionRun::mission() { return impl_->mission; }

}  // namespace spelunk::evaluation
