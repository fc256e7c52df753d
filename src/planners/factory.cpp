#include "spelunk/planners/factory.h"

#include <optional>

#include "spelunk/common/contract.h"
#include "spelunk/planners/baselines/frontier_planner.h"
#include "spelunk/planners/baselines/nbvp_planner.h"
#include "spelunk/planners/baselines/oracle_planner.h"
#include "spelunk/planners/gbplanner/gb_planner.h"
#include "spelunk/planners/informed/informed_planner.h"

namespace spelunk::planners {
namespace {

constexpr const char* kOracle = "oracle";

template <class Params>
Params paramsOf(const std::string& section, ParamTree& tree, Params params = {}) {
  tree.read(section, params);
  return params;
}

/// What a planner is made for.
struct Task {
  const RobotModel& robot;
  double resolution_m;
};

/// The same, its rules between fields checked as well, and those with the robot and the map.
template <class Params>
Params checkedParamsOf(const std::string& section, ParamTree& tree, const Task& task,
                       const Params& defaults = {}) {
  const Params params = paramsOf(section, tree, defaults);
  for (const std::string& problem : params.problems()) tree.addProblem(section + ": " + problem);
  for (const std::string& problem : params.problemsFor(task.robot, task.resolution_m))
    tree.addProblem(section + ": " + problem);
  return params;
}

[[noreturn]] void refuseUnknown(const std::string& name) {
  std::string known;
  for (const std::string& each : plannerNames()) known += (known.empty() ? "" : ", ") + each;
  throw OutsideError("planner \"" + name + "\" is not known; choose one of: " + known + ", " +
                     kOracle);
}

std::optional<baselines::Preference> preferenceOf(const std::string& name) {
  if (name == "frontier_nearest" || name == "frontier_rrt_star")
    return baselines::Preference::kNearest;
  if (name == "frontier_utility") return baselines::Preference::kUtility;
  return std::nullopt;
}

baselines::FrontierPlannerParams frontierDefaults(const std::string& name) {
  if (name == "frontier_rrt_star") return baselines::FrontierPlannerParams::forRrtStar();
  if (name == "frontier_nearest") return baselines::FrontierPlannerParams::forNearest();
  return {};
}

void requireFlying(const std::string& name, const RobotModel& robot) {
  if (kindOf(robot) != RobotKind::kAerial)
    throw OutsideError("planner \"" + name + "\" is for robots that fly; robot \"" + robot.name +
                       "\" does not");
}

}  // namespace

std::vector<std::string> plannerNames() {
  return {"gbplanner",        "informed",          "frontier_nearest",
          "frontier_utility", "frontier_rrt_star", "nbvp"};
}

std::vector<ParamDescription> describePlanner(const std::string& name, ParamTree& tree,
                                              const RobotModel& robot) {
  if (name == "gbplanner")
    return describe(name, paramsOf<gbplanner::GbPlannerParams>(name, tree).resolvedFor(robot));
  if (name == "informed")
    return describe(name, paramsOf<informed::InformedParams>(name, tree).resolvedFor(robot));
  if (name == kOracle) return describe(name, paramsOf<baselines::OracleParams>(name, tree));
  if (name == "nbvp")
    return describe(name, paramsOf<baselines::NbvpParams>(name, tree).resolvedFor(robot));
  if (preferenceOf(name))
    return describe(name, paramsOf(name, tree, frontierDefaults(name)).resolvedFor(robot));
  refuseUnknown(name);
}

std::unique_ptr<ExplorationPlanner> makePlanner(const std::string& name, ParamTree& tree,
                                                const RobotModel& robot, double resolution_m) {
  const Task task{robot, resolution_m};
  if (name == "gbplanner")
    return std::make_unique<gbplanner::GbPlanner>(
        checkedParamsOf<gbplanner::GbPlannerParams>(name, tree, task).resolvedFor(robot), robot,
        resolution_m);
  if (name == "informed") {
    requireFlying(name, robot);
    return std::make_unique<informed::InformedPlanner>(
        checkedParamsOf<informed::InformedParams>(name, tree, task), robot, resolution_m);
  }
  if (name == "nbvp")
    return std::make_unique<baselines::NbvpPlanner>(
        checkedParamsOf<baselines::NbvpParams>(name, tree, task).resolvedFor(robot), robot,
        resolution_m);
  if (name == kOracle) {
    const auto params = paramsOf<baselines::OracleParams>(name, tree);
    return std::make_unique<baselines::OraclePlanner>(params, baselines::readTour(params.tour),
                                                      robot);
  }
  if (const auto preference = preferenceOf(name)) {
    requireFlying(name, robot);
    return std::make_unique<baselines::FrontierPlanner>(
        checkedParamsOf(name, tree, task, frontierDefaults(name)).resolvedFor(robot), *preference,
        robot, resolution_m);
  }
  refuseUnknown(name);
}

}  // namespace spelunk::planners
