#include "spelunk/evaluation/mission_run.h"

#include <algorithm>
#include <cmath>

#include "mail.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/stopwatch.h"

namespace spelunk::evaluation {
namespace {

constexpr int kTicksPerSecond = 10;
constexpr int kWarmUpTicks = 5;  // scans before the mission is started
constexpr double kClearanceLimit_m = 5.0;
constexpr double kRateWindow_s = 10.0;
constexpr double kOutOfEndurance_s = 0.05;

}  // namespace

struct MissionRun::Impl {
  Impl(const RunSetup& run_setup, const sim::WorldMesh& mesh,
       planners::ExplorationPlanner& run_planner)
      : setup(run_setup),
        planner(run_planner),
        simulator(setup.sim, setup.robot, mesh, setup.start, setup.seed),
        mission(setup.mission, setup.robot, setup.map, setup.seed, setup.terrain),
        explored(mesh.bounds()),
        scans(setup.delays.scan_s),
        outcomes(setup.delays.plan_s),
        losses(Rng(setup.seed).fork("run/lost scans")) {
    record.min_clearance_m = kClearanceLimit_m;
    last_position = simulator.trueState().pose.position;
  }

  RunRecord fly(const std::function<void(const Progress&)>& show);
  void warmUp();
  void step();
  void sense();
  void plan();
  void takeOver();
  [[nodiscard]] bool getsLost();
  void measure();
  void follow(const std::optional<mission::Command>& command);
  void addTimelineRow();
  [[nodiscard]] bool isOver() const;
  void finish();
  [[nodiscard]] double now() const { return static_cast<double>(ticks) / kTicksPerSecond; }
  [[nodiscard]] double remaining() const;
  [[nodiscard]] Progress progress() const;

  RunSetup setup;
  planners::ExplorationPlanner& planner;
  sim::Simulator simulator;
  mission::Mission mission;
  ExploredVolume explored;
  Mail<Scan> scans;
  Mail<mission::PlanOutcome> outcomes;
  Rng losses;
  RunRecord record;
  std::int64_t ticks = 0;
  double started_s = 0.0;
  Eigen::Vector3d last_position = Eigen::Vector3d::Zero();
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
  for (const Scan& scan : scans.take(now())) {
    mission.onScan(scan);
    record.map_update_ms.push_back(mission.status().last_map_update_ms);
  }
  mission.onOdometry(simulator.odometry());
  mission.onRemaining(remaining());
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
  if (command) simulator.follow(command->trajectory);
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
  row.explore = job->explore;
  row.result = job->explore ? outcome.plan : outcome.home;
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
  if (ticks % kTicksPerSecond == 0) addTimelineRow();
}

void MissionRun::Impl::warmUp() {
  for (int k = 0; k < kWarmUpTicks; ++k) {
    ++ticks;
    sense();
    mission.tick(now());
  }
  if (const auto answer = mission.setBounds(setup.bounds); !answer.accepted)
    throw OutsideError("the bounds are refused: " + answer.reason);
  if (const auto answer = mission.setZones(setup.zones); !answer.accepted)
    throw OutsideError("the no-go zones are refused: " + answer.reason);
  started_s = now();
  if (const auto answer = mission.start(); !answer.accepted)
    throw OutsideError("the mission does not start: " + answer.reason);
}

void MissionRun::Impl::addTimelineRow() {
  record.timeline.push_back({now(), explored.volume_m3(), record.path_length_m,
                             simulator.trueState().pose, remaining(), mission.status().state});
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

bool MissionRun::Impl::isOver() const {
  return mission.status().state == mission::MissionState::kDone ||
         simulator.walkerCount().falls > 0 || remaining() <= kOutOfEndurance_s;
}

void MissionRun::Impl::finish() {
  const mission::MissionStatus status = mission.status();
  const Pose pose = simulator.trueState().pose;
  record.mission_time_s = now();
  record.explored_volume_m3 = explored.volume_m3();
  record.collisions = simulator.collisions().episodes;
  record.collision_s = simulator.collisions().seconds;
  record.falls = simulator.walkerCount().falls;
  record.slips = simulator.walkerCount().slips;
  record.trips = simulator.walkerCount().trips;
  record.zones_marked = status.zones_marked;
  record.returned_home = status.state == mission::MissionState::kDone;
  record.remaining_at_home_s = record.returned_home ? remaining() : 0.0;
  record.ended_as_it_may = record.returned_home && remaining() > 0.0;
  record.remaining_targets = mission.remaining();
  record.outcome = record.returned_home ? status.end_reason
                                        : (record.falls > 0 ? "fell " : "stranded ") +
                                              std::to_string(distance(pose, setup.start)) +
                                              " m from home: " + status.reason;
}

RunRecord MissionRun::Impl::fly(const std::function<void(const Progress&)>& show) {
  const Stopwatch watch;
  warmUp();
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

mission::Mission& MissionRun::mission() { return impl_->mission; }

}  // namespace spelunk::evaluation
