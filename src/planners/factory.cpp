#include "spelunk/planners/factory.h"

#include "spelunk/common/contract.h"
#include "spelunk/planners/gbplanner/gb_planner.h"

namespace spelunk::planners {
namespace {

std::unique_ptr<ExplorationPlanner> makeGbPlanner(ParamTree& tree, const RobotModel& robot,
                                                  double resolution_m) {
  gbplanner::GbPlannerParams params;
  tree.read("gbplanner", params);
  for (const std::string& problem : params.problems()) tree.addProblem("gbplanner: " + problem);
  return std::make_unique<gbplanner::GbPlanner>(params, robot, resolution_m);
}

}  // namespace

std::vector<std::string> plannerNames() { return {"gbplanner"}; }

std::unique_ptr<ExplorationPlanner> makePlanner(const std::string& name, ParamTree& tree,
                                                const RobotModel& robot, double resolution_m) {
  if (name == "gbplanner") return makeGbPlanner(tree, robot, resolution_m);
  std::string known;
  for (const std::string& each : plannerNames()) known += (known.empty() ? "" : ", ") + each;
  throw OutsideError("planner \"" + name + "\" is not known; choose one of: " + known);
}

}  // namespace spelunk::planners
