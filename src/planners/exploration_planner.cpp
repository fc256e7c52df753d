#include "spelunk/planners/exploration_planner.h"

#include "spelunk/common/moved.h"

namespace spelunk::planners {
namespace {

void checkRequest(const PlanRequest& request) {
  require(request.map != nullptr, "plan: the request has no map");
  require(isFinite(request.pose), "plan: pose is not finite");
  require(isFinite(request.home), "plan: home is not finite");
  require(request.budget.iterations > 0 && request.budget.seconds > 0.0, "plan: empty budget");
}

void checkResult(const PlanResult& result) {
  require(result.path.empty() == (result.status != PlanStatus::kOk),
          "plan: path and status disagree");
  require(!result.reason.empty(), "plan: a result must give its reason");
}

}  // namespace

const char* toText(PlanStatus status) {
  switch (status) {
    case PlanStatus::kOk:
      return "ok";
    case PlanStatus::kNothingToGain:
      return "nothing_to_gain";
    case PlanStatus::kBudgetSaysHome:
      return "budget_says_home";
    case PlanStatus::kStartBlocked:
      return "start_blocked";
    case PlanStatus::kOutOfBounds:
      return "out_of_bounds";
    case PlanStatus::kNoPath:
      return "no_path";
  }
  return "unknown";
}

const char* toText(PathKind kind) {
  switch (kind) {
    case PathKind::kLocal:
      return "local";
    case PathKind::kReposition:
      return "reposition";
    case PathKind::kHome:
      return "home";
  }
  return "unknown";
}

RemainingTarget moved(RemainingTarget target, const Shift& shift) {
  target.position = shift(target.position);
  target.why = spelunk::moved(target.why, shift);
  return target;
}

PlannerGraph moved(PlannerGraph graph, const Shift& shift) {
  for (GraphLayer& layer : graph.layers)
    for (GraphVertex& vertex : layer.vertices) vertex.position = shift(vertex.position);
  return graph;
}

PlanResult ExplorationPlanner::plan(const PlanRequest& request) {
  checkRequest(request);
  PlanResult result = doPlan(request);
  checkResult(result);
  return result;
}

PlanResult ExplorationPlanner::planHome(const PlanRequest& request) {
  checkRequest(request);
  PlanResult result = doPlanHome(request);
  checkResult(result);
  return result;
}

}  // namespace spelunk::planners
