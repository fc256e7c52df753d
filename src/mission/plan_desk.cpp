#include "spelunk/mission/plan_desk.h"

#include <algorithm>
#include <utility>

#include "spelunk/mission/openings_left.h"

namespace spelunk::mission {
namespace {

using Kind = RunningJob::Kind;

constexpr int kScansBeforePlan = 3;  // one scan alone shows too little around the start
/// Plans that fail from a standstill, or leave no way home, before the mission gives up.
constexpr int kFailuresMax = 5;
constexpr int kUnaffordableMax = 3;
constexpr double kRetryPeriod_s = 0.5;    // the next scans may show more
constexpr double kRetryInFlight_s = 1.0;  // there is still a path to fly
constexpr double kAskBeforeEnd_s = 0.5;   // on top of plan_ahead_s
constexpr double kLatencySlack = 1.3;     // the next plan may take longer than the last one
/// A path that takes over nearer to an obstacle leaves no room to turn away from it.
constexpr double kSpliceClearance_m = 1.0;
constexpr double kLookPeriod_s = 10.0;     // between two looks on the way home
constexpr double kLookBeforeHome_s = 5.0;  // not with home right ahead
constexpr double kHomeRetry_s = 1.0;

}  // namespace

void PlanDesk::askBy(double time_s) { next_ask_s_ = std::min(next_ask_s_, time_s); }

void PlanDesk::beginExploring(double now_s) {
  failures_ = 0;
  next_ask_s_ = now_s;
}

void PlanDesk::beginHome(SecondLooks looks, double now_s) {
  may_look_again_ = looks == SecondLooks::kAllowed;
  wants_way_home_ = true;
  next_ask_s_ = now_s;
}

void PlanDesk::drop() {
  pending_.reset();
  running_.reset();
}

bool PlanDesk::wantsPlanInFlight(double now_s) const {
  const PathExecution& active = *basis_.flight.active();
  const double left_s = active.endTime() - now_s;
  if (active.blockedAt()) return true;
  if (left_s <= basis_.params.plan_ahead_s + kAskBeforeEnd_s) return true;
  return active.kind() == planners::PathKind::kLocal &&
         now_s - last_accept_s_ >= basis_.params.replan_period_s;
}

bool PlanDesk::wantsPlan(Task task, const WayHome& way_home, double now_s) const {
  if (isBusy() || now_s < next_ask_s_) return false;
  const bool flies = basis_.flight.active().has_value();
  const bool is_at_rest = basis_.flight.isAtRest(basis_.watch.state().velocity, now_s);
  if (task == Task::kHome)
    return wants_way_home_ ? flies || is_at_rest : wantsSecondLook(way_home, now_s);
  if (task != Task::kExplore) return false;
  if (flies) return wantsPlanInFlight(now_s);
  return basis_.watch.mappedScans() >= kScansBeforePlan && is_at_rest;
}

/// The way home is flown in less time than was feared, and leads past other places.
bool PlanDesk::wantsSecondLook(const WayHome& way_home, double now_s) const {
  const auto& active = basis_.flight.active();
  return may_look_again_ && active && !active->blockedAt() && now_s >= next_look_s_ &&
         now_s >= last_accept_s_ + kLookPeriod_s && way_home.margin_s() > 0.0 &&
         active->endTime() - now_s > basis_.params.plan_ahead_s + kLookBeforeHome_s;
}

RunningJob::Kind PlanDesk::kindFor(Task task) const {
  if (task != Task::kHome) return Kind::kExplore;
  if (!wants_way_home_) return Kind::kSecondLook;
  return asks_navigation_ && !basis_.flight.active() ? Kind::kNavigationsWayHome
                                                     : Kind::kPlannersWayHome;
}

RunningJob PlanDesk::begin(Kind kind, double now_s) {
  RunningJob job;
  job.number = next_job_++;
  job.kind = kind;
  job.from_standstill = !basis_.flight.active();
  job.asked_s = now_s;
  job.takes_over_s = now_s;
  job.pose = basis_.watch.pose();
  return job;
}

std::shared_ptr<const map::FrozenMap> PlanDesk::freeze(WayHome& way_home) {
  auto map = basis_.space.map().freeze();
  way_home.connect(map);
  const double voxel = map->resolution();
  counts_.known_volume_m3 = static_cast<double>(map->freeVoxels()) * voxel * voxel * voxel;
  return map;
}

void PlanDesk::submit(const RunningJob& job,
                      std::variant<ExplorationJob, WayHomeJob, WayHomeSearch, PointJob> work) {
  pending_ = PlanJob{job.number, {}, std::move(work)};
  running_ = job;
}

planners::PlanRequest PlanDesk::requestAt(const Pose& pose, double time_s,
                                          const WayHome& way_home) {
  planners::PlanRequest request;
  request.map = basis_.space.map().freeze();
  request.time_s = time_s;
  request.pose = pose;
  request.velocity = basis_.watch.state().velocity;
  request.home = way_home.isKnown() ? way_home.home() : pose;
  request.remaining_s = basis_.endurance.guard().disposable(0.0);
  request.bounds = basis_.space.zones().bounds();
  request.zones = basis_.space.zones().all();
  request.zones_revision = basis_.space.zones().revision();
  request.trail = way_home.stampedTrail();
  request.budget.iterations = basis_.params.max_samples;
  return request;
}

void PlanDesk::ask(Task task, WayHome& way_home, double now_s) {
  RunningJob job = begin(kindFor(task), now_s);
  const auto map = freeze(way_home);
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (const auto& active = basis_.flight.active()) {
    const double ahead_s = std::max(basis_.params.plan_ahead_s, kLatencySlack * latency_s_);
    job.takes_over_s = std::min(now_s + ahead_s, std::max(now_s, active->endTime()));
    const TrajectoryPoint then = active->reference(job.takes_over_s);
    job.pose = then.pose;
    velocity = then.velocity;
    const bool is_too_near = active->blockedAt() && active->arcAt(job.takes_over_s) >
                                                        *active->blockedAt() - kSpliceClearance_m;
    if (is_too_near) return;
  }
  const std::string number = std::to_string(job.number);
  if (job.kind == Kind::kNavigationsWayHome)
    return submit(job, way_home.search(job.pose, map, rng_, "way_home/" + number));
  planners::PlanRequest request = requestAt(job.pose, job.takes_over_s, way_home);
  request.velocity = velocity;
  request.remaining_s = basis_.endurance.guard().disposable(job.takes_over_s - now_s);
  request.rng = rng_.fork("plan/" + number);
  if (job.kind == Kind::kPlannersWayHome) return submit(job, WayHomeJob{std::move(request)});
  submit(job, ExplorationJob{std::move(request)});
}

std::optional<PlanJob> PlanDesk::takeJob() {
  std::optional<PlanJob> job = std::exchange(pending_, std::nullopt);
  if (job) job->reports = std::exchange(reports_, {});
  return job;
}

std::optional<RunningJob> PlanDesk::finish(const PlanOutcome& outcome, double now_s) {
  if (!running_ || running_->number != outcome.number) return std::nullopt;
  const RunningJob job = *running_;
  drop();
  latency_s_ = now_s - job.asked_s;
  if (job.kind != Kind::kExplore && job.kind != Kind::kSecondLook) return job;
  ++counts_.plans;
  counts_.last_stats = outcome.plan.stats;
  counts_.last_plan_status = planners::toText(outcome.plan.status);
  planner_left_ = outcome.plan.remaining;
  gatherRemaining();
  return job;
}

void PlanDesk::noteAccepted(const planners::PlanResult& plan, double now_s) {
  failures_ = 0;
  last_accept_s_ = now_s;
  reports_.push_back({plan.memory, planners::PathOutcome::kReplaced, ""});
  flies_reported_path_ = true;
}

void PlanDesk::noteRefused(const planners::PlanResult& plan, planners::PathOutcome outcome,
                           const std::string& why) {
  ++counts_.refused_paths;
  reports_.push_back({plan.memory, outcome, why});
  flies_reported_path_ = false;
}

void PlanDesk::noteNone(const planners::PlanResult& plan) {
  reports_.push_back({plan.memory, planners::PathOutcome::kNone, plan.reason});
  flies_reported_path_ = false;
}

void PlanDesk::noteOutcome(planners::PathOutcome outcome, const std::string& reason) {
  if (flies_reported_path_) reports_.push_back({nullptr, outcome, reason});
}

void PlanDesk::noteSecondLook(const planners::PlanResult& plan, double now_s) {
  next_look_s_ = now_s + kLookPeriod_s;
  if (plan.status == planners::PlanStatus::kNothingToGain) may_look_again_ = false;
}

void PlanDesk::retryInFlight(double now_s) { next_ask_s_ = now_s + kRetryInFlight_s; }

bool PlanDesk::noteFailure(double now_s) {
  next_ask_s_ = now_s + kRetryPeriod_s;
  return ++failures_ >= kFailuresMax;
}

bool PlanDesk::noteUnaffordable() { return ++failures_ >= kUnaffordableMax; }

void PlanDesk::noteNoWayHome(const RunningJob& job, double now_s) {
  next_ask_s_ = now_s + kHomeRetry_s;
  wants_way_home_ = !basis_.flight.active();
  if (basis_.flight.active()) return;
  // Navigation knows nothing of footing.
  asks_navigation_ =
      kindOf(basis_.robot) == RobotKind::kAerial && job.kind != Kind::kNavigationsWayHome;
}

void PlanDesk::noteOpenings(const std::vector<map::Opening>& openings) {
  openings_ = targetsOf(openings);
  gatherRemaining();
}

void PlanDesk::gatherRemaining() {
  remaining_ = planner_left_;
  remaining_.insert(remaining_.end(), openings_.begin(), openings_.end());
}

}  // namespace spelunk::mission
