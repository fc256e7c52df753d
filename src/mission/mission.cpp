#include "spelunk/mission/mission.h"

#include <filesystem>

#include "mission_impl.h"
#include "spelunk/common/contract.h"

namespace spelunk::mission {
namespace {

/// Where nothing returned from; folders of earlier versions lack it.
std::string silenceFile(const std::string& folder) { return folder + "/silence.bt"; }

}  // namespace

Mission::Impl::Impl(const MissionParams& mission_params, const RobotModel& robot_model,
                    const map::MapParams& map_params, std::uint64_t seed,
                    const terrain::TerrainParams& terrain_params)
    : params(mission_params),
      robot(robot_model),
      space(map_params, robot),
      watch(robot),
      endurance({params.reserve_s, params.reserve_percent, params.pessimism}, robot.endurance_s),
      flight(params, robot, space),
      basis{params, robot, watch, endurance, flight, space},
      way_home(basis),
      ground(basis, terrain_params),
      vertical(basis),
      point(basis),
      desk(basis, Rng(seed).fork("mission")) {}

Path Mission::Impl::ofBase(Path path) const {
  for (Pose& pose : path) pose.position.z() -= robot.box_lift_m;
  return path;
}

MissionStatus Mission::Impl::status() const {
  const PlanDesk::Counts& counts = desk.counts();
  MissionStatus status;
  status.time_s = now;
  status.state = shown;
  status.reason = reason;
  status.last_plan_status = counts.last_plan_status;
  status.end_reason = end_reason;
  status.known_volume_m3 = counts.known_volume_m3;
  status.remaining_s = endurance.guard().remaining();
  status.way_home_s = endurance.guard().pessimistic(way_home.travel_s());
  status.margin_s = way_home.margin_s();
  status.distance_m = watch.distance_m();
  status.plans = counts.plans;
  status.replans_obstacle = replans_obstacle;
  status.replans_deviation = replans_deviation;
  status.refused_paths = counts.refused_paths;
  status.way_home_problem = way_home_problem;
  if (flight.active()) status.clear_box_m = flight.active()->box();
  status.zones_marked = space.zones().markedCount();
  status.go_to = point.status();
  status.last_stats = counts.last_stats;
  status.last_map_update_ms = last_map_update_ms;
  return status;
}

Mission::Mission(const MissionParams& params, const RobotModel& robot,
                 const map::MapParams& map_params, std::uint64_t seed,
                 const terrain::TerrainParams& terrain)
    : impl_(new Impl(params, robot, map_params, seed, terrain)) {}
Mission::~Mission() = default;
Mission::Mission(Mission&&) noexcept = default;
Mission& Mission::operator=(Mission&&) noexcept = default;

void Mission::onOdometry(const RobotState& state) { impl_->takeOdometry(state); }
void Mission::noteInputs(const InputNotes& notes) { impl_->notes = notes; }
map::MapUpdate Mission::onScan(const Scan& scan) { return impl_->takeScan(scan); }
void Mission::onRemaining(double remaining_s) { impl_->takeRemaining(remaining_s); }

Answer Mission::start() { return impl_->start(); }
Answer Mission::pause() { return impl_->pause(); }
Answer Mission::home() { return impl_->goHomeAsAsked(); }
Answer Mission::emergencyStop() { return impl_->emergencyStop(); }
Answer Mission::setBounds(const AxisAlignedBox& bounds) { return impl_->setBounds(bounds); }
Answer Mission::setZones(std::vector<NoGoZone> zones) {
  return impl_->space.zones().setGiven(std::move(zones), impl_->watch.position());
}

Answer Mission::mayGoTo(const Eigen::Vector3d& point) {
  const std::string problem = impl_->goToProblem(point);
  return {problem.empty(), problem};
}
Answer Mission::goTo(const Eigen::Vector3d& point, const navigation::NavigationParams& params,
                     double time_limit_s) {
  return impl_->goTo(point, params, time_limit_s);
}
std::optional<planners::PlanRequest> Mission::requestHere(double now_s) {
  if (!impl_->watch.knowsPose()) return std::nullopt;
  return impl_->desk.requestAt(impl_->watch.pose(), now_s, impl_->way_home);
}

std::optional<Command> Mission::tick(double now_s) { return impl_->tick(now_s); }

std::optional<Command> Mission::commandAgain(double now_s) const {
  if (impl_->task == Task::kIdle) return std::nullopt;
  return impl_->flight.commandAgain(now_s);
}

std::optional<PlanJob> Mission::takeJob() { return impl_->desk.takeJob(); }
std::optional<Command> Mission::accept(const PlanOutcome& outcome, double now_s) {
  impl_->take(outcome, now_s);
  return impl_->flight.takeCommand();
}
void Mission::take(const PlanOutcome& outcome, double now_s) { impl_->take(outcome, now_s); }

MissionStatus Mission::status() const { return impl_->status(); }
bool Mission::isRunning() const { return mission::isRunning(impl_->task); }

Path Mission::activePath() const {
  const auto& active = impl_->flight.active();
  return active ? impl_->ofBase(active->waypoints()) : Path{};
}

std::optional<navigation::NavigationAnswer> Mission::goToPlan() const {
  std::optional<navigation::NavigationAnswer> plan = impl_->point.plan();
  if (plan) plan->path = impl_->ofBase(std::move(plan->path));
  return plan;
}

Path Mission::wayHome() const { return impl_->ofBase(impl_->way_home.path()); }
Path Mission::trail() const {
  return impl_->way_home.isKnown() ? impl_->ofBase(impl_->way_home.trail()) : Path{};
}
const AxisAlignedBox& Mission::bounds() const { return impl_->space.zones().bounds(); }
const std::vector<NoGoZone>& Mission::zones() const { return impl_->space.zones().all(); }
const std::vector<planners::RemainingTarget>& Mission::remaining() const {
  return impl_->desk.remaining();
}
map::OccupancyMap& Mission::map() { return impl_->space.map(); }
const RobotModel& Mission::robot() const { return impl_->robot; }
std::shared_ptr<const terrain::TerrainView> Mission::terrain() { return impl_->ground.view(); }

Answer Mission::save(const std::string& folder, const planners::PlannerGraph& graph,
                     const LocalFrame& frame) {
  try {
    MissionRecord record = impl_->record(graph);
    record.frame = frame;
    writeRecord(folder, record);
    impl_->space.map().save(folder + "/map.ot", frame);
    impl_->space.map().save(folder + "/map.bt", frame);
    impl_->space.map().saveSilence(silenceFile(folder), frame);
  } catch (const OutsideError& error) {
    return {false, error.what()};
  }
  return {true, "saved to '" + folder + "'"};
}

Answer Mission::load(const std::string& folder, planners::PlannerGraph* graph) {
  if (isRunning()) return {false, "load: pause the mission first"};
  try {
    MissionRecord record = readRecord(folder);
    impl_->space.map().load(folder + "/map.ot");
    if (std::filesystem::exists(silenceFile(folder)))
      impl_->space.map().loadSilence(silenceFile(folder));
    impl_->takeUp(record);
    if (graph != nullptr) *graph = std::move(record.graph);
  } catch (const OutsideError& error) {
    return {false, error.what()};
  }
  return {true, "loaded from '" + folder + "'"};
}

}  // namespace spelunk::mission
