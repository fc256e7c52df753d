#include "tree_search.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace spelunk::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr unsigned kShortcutSteps = 120;
constexpr unsigned kShortcutMisses = 40;
constexpr double kStarSteps = 4.0;        // RRT* rewires no farther than it steps
constexpr double kNearlyStraight = 1.05;  // no way of RRT* is worth looking for a shorter one
constexpr double kRim_m = 1e-3;           // states on the region's faces are inside for OMPL too
constexpr int kStartTreeTag = 1;          // OMPL's, of vertices that grew from the start

Eigen::Vector3d positionOf(const ob::State* state) {
  const double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1], values[2]};
}

void setPosition(ob::State* state, const Eigen::Vector3d& position) {
  double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  std::copy(position.data(), position.data() + 3, values);
}

/// Draws from our own stream, so that a query repeats.
class SeededSampler : public ob::StateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, const TreeTask& task, Rng* rng)
      : ob::StateSampler(space), task_(task), rng_(rng) {}

  void sampleUniform(ob::State* state) override { setPosition(state, task_.draw(*rng_)); }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    setNear(state, near, [&] { return rng_->uniform(-distance, distance); });
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double stddev) override {
    setNear(state, mean, [&] { return stddev * rng_->normal(); });
  }

 private:
  template <class Draw>
  void setNear(ob::State* state, const ob::State* centre, Draw&& draw) {
    Eigen::Vector3d position = positionOf(centre);
    for (int axis = 0; axis < 3; ++axis) position[axis] += draw();
    setPosition(state, position.cwiseMax(task_.region.min).cwiseMin(task_.region.max));
  }

  const TreeTask& task_;
  Rng* rng_;
};

class SweepValidator : public ob::MotionValidator {
 public:
  SweepValidator(const ob::SpaceInformationPtr& info, const TreeTask& task)
      : ob::MotionValidator(info), task_(task) {}

  /// RRT* takes an edge it found free for free the other way round too.
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return task_.is_free(positionOf(a), positionOf(b)) &&
           (task_.kind == TreeKind::kConnect || task_.is_free(positionOf(b), positionOf(a)));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(a, b)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    last_valid.second = 0.0;
    return false;
  }

 private:
  const TreeTask& task_;
};

/// OMPL's simplifier, whose own random numbers would differ from run to run.
class SeededSimplifier : public og::PathSimplifier {
 public:
  SeededSimplifier(const ob::SpaceInformationPtr& info, Rng rng) : og::PathSimplifier(info) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(rng.next() & 0x7FFFFFFF));
  }
};

/// OMPL's RRT*, whose choice between goal and sample would differ from run to run.
class SeededRrtStar : public og::RRTstar {
 public:
  SeededRrtStar(const ob::SpaceInformationPtr& info, Rng rng) : og::RRTstar(info) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(rng.next() & 0x7FFFFFFF));
  }
};

/// One search; lives for one call.
struct Search {
  Search(const TreeTask& tree_task, Rng stream) : task(tree_task), rng(stream), info(makeInfo()) {}

  ob::SpaceInformationPtr makeInfo() {
    auto states = std::make_shared<ob::RealVectorStateSpace>(3);
    ob::RealVectorBounds bounds(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
      bounds.setLow(axis, task.region.min[axis] - kRim_m);
      bounds.setHigh(axis, task.region.max[axis] + kRim_m);
    }
    states->setBounds(bounds);
    states->setStateSamplerAllocator([this](const ob::StateSpace* of) {
      return std::make_shared<SeededSampler>(of, task, &rng);
    });
    auto made = std::make_shared<ob::SpaceInformation>(states);
    made->setStateValidityChecker([this](const ob::State* state) {
      return task.is_free(positionOf(state), positionOf(state));
    });
    made->setMotionValidator(std::make_shared<SweepValidator>(made, task));
    made->setup();
    return made;
  }

  ob::ScopedState<> stateAt(const Eigen::Vector3d& position) const {
    ob::ScopedState<> state(info);
    setPosition(state.get(), position);
    return state;
  }

  TreeResult run() {
    auto problem = std::make_shared<ob::ProblemDefinition>(info);
    problem->setStartAndGoalStates(stateAt(task.start), stateAt(task.goal));
    if (task.kind == TreeKind::kStar) {
      auto length = std::make_shared<ob::PathLengthOptimizationObjective>(info);
      length->setCostThreshold(ob::Cost(kNearlyStraight * (task.goal - task.start).norm()));
      problem->setOptimizationObjective(length);
    }
    const ob::PlannerPtr planner = makePlanner();
    planner->setProblemDefinition(problem);
    planner->setup();
    ob::IterationTerminationCondition limit(static_cast<unsigned>(task.iterations));
    const ob::PlannerStatus status =
        std::isfinite(task.time_limit_s)
            ? planner->solve(ob::plannerOrTerminationCondition(
                  ob::PlannerTerminationCondition(limit),
                  ob::timedPlannerTerminationCondition(task.time_limit_s)))
            : planner->solve(limit);
    TreeResult result;
    result.iterations = static_cast<int>(limit.getTimesCalled());
    readTrees(*planner, result);
    if (status == ob::PlannerStatus::EXACT_SOLUTION)
      result.line = lineOf(*problem->getSolutionPath()->as<og::PathGeometric>());
    return result;
  }

  ob::PlannerPtr makePlanner() const {
    if (task.kind == TreeKind::kStar) {
      auto planner = std::make_shared<SeededRrtStar>(info, rng.fork("rrt_star"));
      planner->setRange(kStarSteps * task.extension_m);
      return planner;
    }
    auto planner = std::make_shared<og::RRTConnect>(info);
    planner->setRange(task.extension_m);
    return planner;
  }

  void readTrees(const ob::Planner& planner, TreeResult& result) const {
    ob::PlannerData data(info);
    planner.getPlannerData(data);
    for (unsigned i = 0; i < data.numVertices(); ++i) {
      const ob::PlannerDataVertex& vertex = data.getVertex(i);
      result.trees.vertices.push_back(positionOf(vertex.getState()));
      if (task.kind == TreeKind::kStar || vertex.getTag() == kStartTreeTag)
        result.reached.push_back(result.trees.vertices.back());
      std::vector<unsigned> targets;
      data.getEdges(i, targets);
      for (const unsigned to : targets) result.trees.edges.emplace_back(i, to);
    }
  }

  std::vector<Eigen::Vector3d> lineOf(og::PathGeometric path) {
    if (task.line == TreeLine::kSimplified) simplify(path);
    std::vector<Eigen::Vector3d> line;
    for (const ob::State* state : path.getStates()) line.push_back(positionOf(state));
    return task.line == TreeLine::kSimplified ? withoutNeedless(line) : line;
  }

  void simplify(og::PathGeometric& path) {
    SeededSimplifier simplifier(info, rng.fork("simplify"));
    simplifier.reduceVertices(path);
    simplifier.shortcutPath(path, kShortcutSteps, kShortcutMisses);
    simplifier.collapseCloseVertices(path);
    simplifier.reduceVertices(path);
  }

  /// From each kept point straight to the last one that can be reached.
  std::vector<Eigen::Vector3d> withoutNeedless(const std::vector<Eigen::Vector3d>& line) {
    std::vector<Eigen::Vector3d> kept{line.front()};
    for (std::size_t at = 0; at + 1 < line.size();) {
      std::size_t next = line.size() - 1;
      while (next > at + 1 && !task.is_free(line[at], line[next])) --next;
      kept.push_back(line[next]);
      at = next;
    }
    return kept;
  }

  const TreeTask& task;
  Rng rng;
  ob::SpaceInformationPtr info;
};

}  // namespace

TreeResult growTrees(const TreeTask& task, Rng rng) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  return Search(task, rng).run();
}

}  // namespace spelunk::navigation
