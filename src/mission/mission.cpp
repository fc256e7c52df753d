#include "spelunk/mission/mission.h"

#include "mission_impl.h"
#include "spelunk/common/contract.h"

namespace spelunk::mission {

const char* toText(MissionState state) {
  switch (state) {
    case MissionState::kIdle:
      return "Idle";
    case MissionState::kExplore:
      return "Explore";
    case MissionState::kReposition:
      return "Reposition";
    case MissionState::kHome:
      return "Home";
    case MissionState::kHold:
      return "Hold";
    case MissionState::kDone:
      return "Done";
    case MissionState::kEStop:
      return "EStop";
  }
  return "unknown";
}

const char* toText(GoToOutcome outcome) {
  switch (outcome) {
    case GoToOutcome::kNone:
      return "none";
    case GoToOutcome::kUnderway:
      return "underway";
    case GoToOutcome::kReached:
      return "reached";
    case GoToOutcome::kUnreachable:
      return "unreachable";
    case GoToOutcome::kAborted:
      return "aborted";
  }
  return "unknown";
}

PlanOutcome run(const PlanJob& job, planners::ExplorationPlanner& planner) {
  PlanOutcome outcome;
  outcome.number = job.number;
  if (job.go_to) {
    outcome.go_to = navigation::Navigator(job.go_to->params).plan(job.go_to->query);
    return outcome;
  }
  if (job.way_home) {
    outcome.home = findWayHome(*job.way_home);
    return outcome;
  }
  planners::PlanRequest request = job.request;
  if (job.explore) {
    outcome.plan = planner.plan(request);
    if (!outcome.plan.path.empty()) request.pose = outcome.plan.path.back();
    request.rng = job.request.rng.fork("home");
  }
  outcome.home = planner.planHome(request);
  return outcome;
}

Mission::Mission(const MissionParams& params, const RobotModel& robot,
                 const map::MapParams& map_params, std::uint64_t seed,
                 const terrain::TerrainParams& terrain)
    : impl_(new Impl(params, robot, map_params, seed, terrain)) {}
Mission::~Mission() = default;

void Mission::onOdometry(const RobotState& state) { impl_->takeOdometry(state); }
map::MapUpdate Mission::onScan(const Scan& scan) { return impl_->takeScan(scan); }
void Mission::onRemaining(double remaining_s) { impl_->takeRemaining(remaining_s); }

Answer Mission::start() { return impl_->start(); }
Answer Mission::pause() { return impl_->pause(); }
Answer Mission::home() { return impl_->goHomeAsAsked(); }
Answer Mission::emergencyStop() { return impl_->emergencyStop(); }
Answer Mission::setBounds(const AxisAlignedBox& bounds) { return impl_->setBounds(bounds); }
Answer Mission::setZones(std::vector<NoGoZone> zones) { return impl_->setZones(std::move(zones)); }

Answer Mission::mayGoTo(const Eigen::Vector3d& point) {
  const std::string problem = impl_->goToProblem(point);
  return {problem.empty(), problem};
}
std::optional<navigation::NavigationQuery> Mission::goToQuery(const Eigen::Vector3d& point) {
  return impl_->goToQuery(point);
}
Answer Mission::goTo(const navigation::NavigationParams& params,
                     const navigation::NavigationQuery& query,
                     const navigation::NavigationAnswer& answer) {
  return impl_->goTo(params, query, answer);
}
std::optional<planners::PlanRequest> Mission::requestHere(double now_s) {
  return impl_->requestHere(now_s);
}

std::optional<Command> Mission::tick(double now_s) { return impl_->tick(now_s); }

std::optional<PlanJob> Mission::takeJob() {
  std::optional<PlanJob> job = std::move(impl_->pending);
  impl_->pending.reset();
  return job;
}

std::optional<Command> Mission::accept(const PlanOutcome& outcome, double now_s) {
  return impl_->accept(outcome, now_s);
}

MissionStatus Mission::status() const { return impl_->status; }

Path Mission::activePath() const {
  return impl_->active ? impl_->ofBase(impl_->active->waypoints()) : Path{};
}

std::optional<navigation::NavigationAnswer> Mission::goToPlan() const {
  if (!impl_->go_to) return std::nullopt;
  navigation::NavigationAnswer plan = impl_->go_to->plan;
  plan.path = impl_->ofBase(std::move(plan.path));
  return plan;
}

Path Mission::wayHome() const { return impl_->ofBase(impl_->way_home); }
Path Mission::trail() const {
  return impl_->home_graph ? impl_->ofBase(impl_->home_graph->trail()) : Path{};
}
const AxisAlignedBox& Mission::bounds() const { return impl_->limits; }
const std::vector<NoGoZone>& Mission::zones() const { return impl_->no_go; }
const std::vector<planners::RemainingTarget>& Mission::remaining() const {
  return impl_->remaining_targets;
}
map::OccupancyMap& Mission::map() { return impl_->map; }
const RobotModel& Mission::robot() const { return impl_->robot; }
std::shared_ptr<const terrain::TerrainView> Mission::terrain() {
  return impl_->terrain ? impl_->terrain->freeze() : nullptr;
}

Answer Mission::save(const std::string& folder, const planners::PlannerGraph& graph) {
  try {
    writeRecord(folder, impl_->record(graph));
    impl_->map.save(folder + "/map.ot");
    impl_->map.save(folder + "/map.bt");
  } catch (const OutsideError& error) {
    return {false, error.what()};
  }
  return {true, "saved to '" + folder + "'"};
}

Answer Mission::load(const std::string& folder, planners::PlannerGraph* graph) {
  if (impl_->isFlying()) return {false, "load: pause the mission first"};
  try {
    MissionRecord record = readRecord(folder);
    impl_->map.load(folder + "/map.ot");
    impl_->takeUp(record);
    if (graph != nullptr) *graph = std::move(record.graph);
  } catch (const OutsideError& error) {
    return {false, error.what()};
  }
  return {true, "loaded from '" + folder + "'"};
}

}  // namespace spelunk::mission
