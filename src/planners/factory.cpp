#include "spelunk/planners/factory.h"

#include "spelunk/common/contract.h"
#include "spelunk/planners/gbplanner/gb_planner.h"

namespace spelunk::planners {
namespace {

gbplanner::GbPlannerParams gbPlannerParams(ParamTree& tree) {
  gbplanner::GbPlannerParams params;
  tree.read("gbplanner", params);
  return params;
}

[[noreturn]] void refuseUnknown(const std::string& name) {
  std::string known;
  for (const std::string& each : plannerNames()) known += (known.empty() ? "" : ", ") + each;
  throw OutsideError("planner \"" + name + "\" is not known; choose one of: " + known);
}

std::unique_ptr<ExplorationPlanner> makeGbPlanner(ParamTree& tree, const RobotModel& robot,
                                                  double resolution_m) {
  const gbplanner::GbPlannerParams params = gbPlannerParams(tree);
  for (const std::string& problem : params.problems()) tree.addProblem("gbplanner: " + problem);
  return std::make_unique<gbplanner::GbPlanner>(params, robot, resolution_m);
}

}  // namespace

std::vector<std::string> plannerNames() { return {"gbplanner"}; }

std::vector<ParamDescription> describePlanner(const std::string& name, ParamTree& tree) {
  if (name == "gbplanner") return describe("gbplanner", gbPlannerParams(tree));
  refuseUnknown(name);
}

std::unique_ptr<ExplorationPlanner> makePlanner(const std::string& name, ParamTree& tree,
                                                const RobotModel& robot, double resolution_m) {
  if (name == "gbplanner") return makeGbPlanner(tree, robot, resolution_m);
  refuseUnknown(name);
}

}  // namespace spelunk::planners
