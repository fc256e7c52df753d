#include "spelunk/navigation/point_to_point.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"
#include "spelunk/map/configuration_space.h"

namespace spelunk::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kExtension_m = 3.0;
constexpr int kShortcutTries = 200;

Eigen::Vector3d positionOf(const ob::State* state) {
  const double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1], values[2]};
}

/// Where the robot's box may be and move.
class FreeSpace {
 public:
  explicit FreeSpace(const PointToPointRequest& request)
      : request_(request), space_(request.box, request.map) {}

  [[nodiscard]] bool isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    if (!request_.bounds.contains(a) || !request_.bounds.contains(b)) return false;
    const bool meets_zone =
        std::any_of(request_.zones.begin(), request_.zones.end(),
                    [&](const NoGoZone& zone) { return sweptBoxMeets(zone, a, b, request_.box); });
    return !meets_zone && space_.isSweepFree(a, b);
  }

 private:
  const PointToPointRequest& request_;
  map::ConfigurationSpace space_;
};

/// Draws from our own stream, so that a query repeats.
class SeededSampler : public ob::StateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, const ob::RealVectorBounds& bounds, Rng* rng)
      : ob::StateSampler(space), bounds_(bounds), rng_(rng) {}

  void sampleUniform(ob::State* state) override {
    double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    for (std::size_t axis = 0; axis < 3; ++axis)
      values[axis] = rng_->uniform(bounds_.low[axis], bounds_.high[axis]);
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    sampleAround(state, near, [&] { return rng_->uniform(-distance, distance); });
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double stddev) override {
    sampleAround(state, mean, [&] { return stddev * rng_->normal(); });
  }

 private:
  template <class Draw>
  void sampleAround(ob::State* state, const ob::State* centre, Draw&& draw) {
    const Eigen::Vector3d middle = positionOf(centre);
    double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    for (std::size_t axis = 0; axis < 3; ++axis)
      values[axis] = std::clamp(middle[static_cast<Eigen::Index>(axis)] + draw(), bounds_.low[axis],
                                bounds_.high[axis]);
  }

  ob::RealVectorBounds bounds_;
  Rng* rng_;
};

class SweepValidator : public ob::MotionValidator {
 public:
  SweepValidator(const ob::SpaceInformationPtr& space, FreeSpace* free)
      : ob::MotionValidator(space), free_(free) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return free_->isFree(positionOf(a), positionOf(b));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(a, b)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    last_valid.second = 0.0;
    return false;
  }

 private:
  FreeSpace* free_;
};

/// One query; lives for one call.
class Query {
 public:
  explicit Query(const PointToPointRequest& request)
      : request_(request), free_(request), rng_(request.rng.fork("rrt_connect")) {}

  PointToPointResult answer() {
    PointToPointResult result = checkEnds();
    if (!result.reason.empty()) return result;
    if (free_.isFree(request_.start.position, request_.goal.position)) {
      result = {
          PointToPointStatus::kOk, "the straight line is free", {request_.start, request_.goal}, 0};
      return result;
    }
    return search();
  }

 private:
  PointToPointResult checkEnds() {
    if (!request_.bounds.contains(request_.goal.position))
      return {PointToPointStatus::kOutOfBounds, "the goal lies outside the bounds", {}, 0};
    if (!isPlaceFree(request_.start))
      return {PointToPointStatus::kStartBlocked, "the start is not in known free space", {}, 0};
    if (!isPlaceFree(request_.goal))
      return {PointToPointStatus::kGoalBlocked,
              "the goal is not in known free space or lies in a no-go zone",
              {},
              0};
    return {};
  }

  bool isPlaceFree(const Pose& pose) { return free_.isFree(pose.position, pose.position); }

  ob::RealVectorBounds searchBounds() const {
    AxisAlignedBox region = intersection(request_.map->knownBounds(), request_.bounds);
    region = hull(region, {request_.start.position, request_.start.position});
    region = hull(region, {request_.goal.position, request_.goal.position});
    ob::RealVectorBounds bounds(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
      bounds.setLow(axis, region.min[axis] - 1e-3);
      bounds.setHigh(axis, region.max[axis] + 1e-3);
    }
    return bounds;
  }

  ob::SpaceInformationPtr makeSpace() {
    auto space = std::make_shared<ob::RealVectorStateSpace>(3);
    const ob::RealVectorBounds bounds = searchBounds();
    space->setBounds(bounds);
    space->setStateSamplerAllocator([this, bounds](const ob::StateSpace* of) {
      return std::make_shared<SeededSampler>(of, bounds, &rng_);
    });
    auto info = std::make_shared<ob::SpaceInformation>(space);
    info->setStateValidityChecker([this](const ob::State* state) {
      return free_.isFree(positionOf(state), positionOf(state));
    });
    info->setMotionValidator(std::make_shared<SweepValidator>(info, &free_));
    info->setup();
    return info;
  }

  static ob::ScopedState<> stateOf(const ob::SpaceInformationPtr& info, const Pose& pose) {
    ob::ScopedState<> state(info);
    for (unsigned axis = 0; axis < 3; ++axis) state[axis] = pose.position[axis];
    return state;
  }

  PointToPointResult search() {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    const ob::SpaceInformationPtr info = makeSpace();
    auto problem = std::make_shared<ob::ProblemDefinition>(info);
    problem->setStartAndGoalStates(stateOf(info, request_.start), stateOf(info, request_.goal));
    og::RRTConnect planner(info);
    planner.setRange(kExtension_m);
    planner.setProblemDefinition(problem);
    planner.setup();
    ob::IterationTerminationCondition limit(static_cast<unsigned>(request_.iterations));
    const ob::PlannerStatus status = planner.solve(limit);
    const int samples = static_cast<int>(limit.getTimesCalled());
    if (status != ob::PlannerStatus::EXACT_SOLUTION)
      return {PointToPointStatus::kNoPath,
              "no path through known free space within " + std::to_string(request_.iterations) +
                  " samples",
              {},
              samples};
    Path path = shortened(pathOf(*problem->getSolutionPath()->as<og::PathGeometric>()));
    path.front() = request_.start;  // cutting has rounded them
    path.back() = request_.goal;
    return {PointToPointStatus::kOk, "found by RRT-Connect", std::move(path), samples};
  }

  Path pathOf(const og::PathGeometric& solution) const {
    Path path;
    for (const ob::State* state : const_cast<og::PathGeometric&>(solution).getStates())
      path.push_back({positionOf(state), request_.start.yaw});
    path.front() = request_.start;
    path.back() = request_.goal;
    return path;
  }

  /// Cuts between random places of the path, then drops every waypoint that can be passed by.
  Path shortened(Path path) {
    for (int k = 0; k < kShortcutTries && path.size() > 2; ++k) {
      const double length = lengthOf(path);
      const double from = rng_.uniform(0.0, length);
      const double to = rng_.uniform(from, length);
      const Pose a = poseAt(path, from);
      const Pose b = poseAt(path, to);
      if (!free_.isFree(a.position, b.position)) continue;
      Path cut = slice(path, 0.0, from);
      const Path rest = slice(path, to, length);
      cut.insert(cut.end(), rest.begin(), rest.end());
      path = std::move(cut);
    }
    return withoutNeedlessWaypoints(path);
  }

  Path withoutNeedlessWaypoints(const Path& path) {
    Path kept{path.front()};
    std::size_t at = 0;
    while (at + 1 < path.size()) {
      std::size_t next = path.size() - 1;
      while (next > at + 1 && !free_.isFree(path[at].position, path[next].position)) --next;
      kept.push_back(path[next]);
      at = next;
    }
    return kept;
  }

  const PointToPointRequest& request_;
  FreeSpace free_;
  Rng rng_;
};

}  // namespace

const char* toText(PointToPointStatus status) {
  switch (status) {
    case PointToPointStatus::kOk:
      return "ok";
    case PointToPointStatus::kStartBlocked:
      return "start_blocked";
    case PointToPointStatus::kGoalBlocked:
      return "goal_blocked";
    case PointToPointStatus::kOutOfBounds:
      return "out_of_bounds";
    case PointToPointStatus::kNoPath:
      return "no_path";
  }
  return "unknown";
}

PointToPointResult planPointToPoint(const PointToPointRequest& request) {
  require(request.map != nullptr, "planPointToPoint: no map");
  require(isFinite(request.start) && isFinite(request.goal),
          "planPointToPoint: start or goal is not finite");
  require(request.iterations > 0, "planPointToPoint: no iterations");
  return Query(request).answer();
}

}  // namespace spelunk::navigation
