#include "spelunk/mission/plan_job.h"

namespace spelunk::mission {
namespace {

/// Does the work of a job, whatever it is.
struct Worker {
  planners::ExplorationPlanner& planner;
  PlanOutcome& outcome;

  void operator()(const ExplorationJob& job) {
    outcome.plan = planner.plan(job.request);
    planners::PlanRequest from_end = job.request;
    if (!outcome.plan.path.empty()) from_end.pose = outcome.plan.path.back();
    from_end.after = outcome.plan.memory;
    from_end.rng = job.request.rng.fork("home");
    outcome.home = planner.planHome(from_end);
  }
  void operator()(const WayHomeJob& job) { outcome.home = planner.planHome(job.request); }
  void operator()(const WayHomeSearch& search) { outcome.home = findWayHome(search); }
  void operator()(const PointJob& job) {
    outcome.go_to = navigation::Navigator(job.params).plan(job.query);
  }
};

}  // namespace

PlanOutcome run(const PlanJob& job, planners::ExplorationPlanner& planner) {
  PlanOutcome outcome;
  outcome.number = job.number;
  for (const planners::PathReport& report : job.reports) planner.report(report);
  std::visit(Worker{planner, outcome}, job.work);
  return outcome;
}

bool isExploration(const PlanJob& job) { return std::holds_alternative<ExplorationJob>(job.work); }

}  // namespace spelunk::mission
