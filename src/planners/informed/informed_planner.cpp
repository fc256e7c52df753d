#include "spelunk/planners/informed/informed_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/common/stopwatch.h"
#include "spelunk/planners/informed/exploration_turn.h"
#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_start.h"

namespace spelunk::planners::informed {
namespace {

using graph::Polyline;
using graph::VertexId;

FrontierViewParams viewParams(const InformedParams& params) {
  return {params.range_m, {params.closing_height_m, params.growth_m}};
}

navigation::NavigationParams navigationParams(const InformedParams& params) {
  navigation::NavigationParams navigation;
  navigation.safe_distance_m = params.safe_distance_m;
  navigation.iterations = params.iterations;
  return navigation;
}

GraphLayer layerOf(const navigation::NavigationTrees& trees) {
  GraphLayer layer{"search", {}, trees.edges};
  for (const Eigen::Vector3d& vertex : trees.vertices)
    layer.vertices.push_back({vertex, 0.0, false});
  return layer;
}

}  // namespace

/// State shared by the steps of one plan.
struct InformedPlanner::Search {
  InformedPlanner& planner;
  const PlanRequest& request;
  InformedMemory memory;  ///< A copy: what it learns counts if the plan is taken.
  const InformedParams& params;
  KnownSpace space;
  FrontierSurvey survey;
  PlanResult result{};
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  VertexId current{};
  std::optional<Proposal> previous{};

  Search(InformedPlanner& owner, const PlanRequest& asked)
      : planner(owner),
        request(asked),
        memory(owner.recall(asked)),
        params(owner.params_),
        space(asked, owner.robot_, owner.navigator_, owner.boxes_),
        survey(owner.view_, asked, owner.params_) {}

  [[nodiscard]] bool findRoot() {
    const StartCheck start = checkStart(request, space.free());
    if (!start.root) return result = refusedStart(start), false;
    root = *start.root;
    return true;
  }

  /// A target that was reached and still promises what it promised keeps its secret for good.
  void noteOutcome() {
    previous = std::exchange(memory.proposal, std::nullopt);
    if (previous)
      memory.tried.note(previous->path.back().position, memory.last.outcome, memory.last.reason,
                        request.time_s);
    memory.tried.age(request.time_s);
    for (const Visit& visit : memory.visits.takeMade(request, memory.last.outcome))
      if (gainAt(visit.place) >= std::max(kShareLeft * visit.gain_m3, params.gain_min_m3))
        memory.tried.giveUp(visit.place, "been there: what it promised cannot be seen from it");
  }

  [[nodiscard]] double gainAt(const Eigen::Vector3d& place) const {
    return planner.view_.seenFrom(place, request.pose.yaw, request.bounds).unknown_m3;
  }

  /// Alg. 1, line 14, for what was flown since the last plan.
  void growGraph() {
    if (memory.checked_map != request.map || memory.checked_zones != request.zones_revision) {
      const bool has_new_zones = memory.checked_zones != request.zones_revision;
      memory.growth.forgetChecksNear(root, has_new_zones ? std::numeric_limits<double>::infinity()
                                                         : longestRange(planner.robot_));
      memory.checked_map = request.map;
      memory.checked_zones = request.zones_revision;
    }
    current = memory.growth.grow(request, root, survey, space);
    memory.growth.rejoinHome(current, space);
  }

  /// While what the path leads to is still to be seen, it is flown on.
  [[nodiscard]] bool fliesOn() {
    if (!previous || previous->kind != PathKind::kLocal ||
        memory.last.outcome != PathOutcome::kReplaced)
      return false;
    const PathProjection at = project(previous->path, request.pose.position);
    Path rest = slice(previous->path, at.arc_m, lengthOf(previous->path));
    constexpr double kBeside_m = 0.3;
    constexpr double kNearlyThere_m = 0.5;
    if (at.distance_m > kBeside_m || lengthOf(rest) < kNearlyThere_m) return false;
    rest.front() = request.pose;
    const double gain_m3 = gainAt(rest.back().position);
    if (gain_m3 < std::max(kShareLeft * previous->gain_m3, params.gain_min_m3)) return false;
    if (!space.isFree(toLine(rest)) || !fitsBudget(lengthOf(rest), rest.back().position))
      return false;
    result.stats.vertices = static_cast<int>(rest.size());
    propose({std::move(rest), PathKind::kLocal, previous->gain_m3, previous->voxel});
    result.reason = "on to the frontier sample of before";
    return true;
  }

  void propose(Proposal proposal) {
    result.status = PlanStatus::kOk;
    result.kind = proposal.kind;
    result.path = proposal.path;
    result.stats.best_gain = proposal.gain_m3;
    memory.proposal = std::move(proposal);
  }

  /// The contextual reasoner R_cr: is there time for a way of this length and then home, back along
  /// it and by the graph, else as the motion planner finds it?
  [[nodiscard]] bool fitsBudget(double length_m, const Eigen::Vector3d& end) {
    const ReachabilityGraph& graph = memory.growth.graph();
    const double home_m = graph.cheapestPath(current, ReachabilityGraph::home()).length;
    if (fitsMetres(2.0 * length_m + home_m)) return true;
    if (!fitsMetres(length_m + (request.home.position - end).norm())) return false;
    if (++ways_home > kWaysHomeMax) return false;
    const auto answer = space.navigate(end, request.home.position, "home from a sample",
                                       navigation::TreeDetail::kLeaveOut);
    return answer.status == navigation::NavigationStatus::kOk &&
           fitsMetres(length_m + lengthOf(answer.path));
  }

  /// Whether straight ways there and from there home would fit.
  [[nodiscard]] bool isInReach(const Eigen::Vector3d& place) const {
    return fitsMetres((place - root).norm() + (request.home.position - place).norm());
  }

  [[nodiscard]] bool fitsMetres(double metres) const {
    return params.eta_factor * metres / planner.robot_.speed_max_mps <= request.remaining_s;
  }

  /// What was too far from where the robot was may be near enough from here.
  void reopenAffordable() {
    ReachabilityGraph& graph = memory.growth.graph();
    for (const VertexId vertex : graph.vertices()) {
      VertexLabel& label = graph.update(vertex);
      if (!label.is_over_budget || label.closed_because.empty()) continue;
      if ((label.closed_from - root).norm() < params.range_m ||
          !isInReach(graph.graph().position(vertex)))
        continue;
      label.closed_because.clear();
      label.is_explored = label.is_over_budget = false;
    }
  }

  void explore() {
    const Stopwatch watch;
    reopenAffordable();
    const Region region =
        regionAt(*request.map, {root, request.pose.yaw}, params.branch_distance_m);
    CandidateJudge judge{
        request, planner.view_,
        params,  memory.tried,
        space,   root,
        region,  0.0,
        {},      [this](const Eigen::Vector3d& place) { return isInReach(place); }};
    ExplorationTurn turn(
        memory.growth, survey, judge, request.rng.fork("sampler"),
        [this](const Candidate& candidate) {
          return fitsBudget(graph::lengthOf(candidate.way), candidate.sample.place);
        },
        [this](VertexId from) { return scout(from); },
        [&]() {
          return memory.approaches.find(
              memory.scouting.seenFromAfar(memory.growth.graph(), planner.view_), judge);
        });
    std::optional<Choice> choice = turn.chooseFrom(current);
    if (!choice && reopenClosed()) choice = turn.chooseFrom(current);
    turn.fill(result.stats);
    result.stats.graph_ms = watch.milliseconds();
    planner.samples_layer_ = turn.samplesLayer();
    if (!choice) return reportNothingLeft(turn);
    planner.search_layer_ = layerOf(choice->candidate.trees);
    result.stats.vertices += static_cast<int>(choice->candidate.trees.vertices.size());
    propose({pathFrom(request.pose, root, choice->candidate.way), choice->kind,
             choice->candidate.gain_m3, choice->candidate.sample.voxel});
    const Candidate& chosen = choice->candidate;
    if (!chosen.is_approach)
      memory.visits.expect(
          {chosen.sample.voxel, chosen.sample.place, chosen.gain_m3, request.time_s});
    const auto whole = [](double number) { return std::to_string(std::lround(number)); };
    result.reason = chosen.is_approach
                        ? "towards frontier seen from afar, "
                        : std::string("to a frontier sample in a ") + toText(region) + ", ";
    result.reason +=
        whole(chosen.gain_m3) + " m3 to be seen, " + whole(chosen.whole_way_m) + " m away" +
        (chosen.is_approach ? "; " + whole(lengthOf(result.path)) + " m of the way are known" : "");
  }

  [[nodiscard]] bool scout(VertexId from) {
    const int found = memory.scouting.scout(from, params.ranked_vertices, memory.growth,
                                            planner.view_, request, space);
    if (found > 0) survey.refresh(memory.growth.graph());
    return found > 0;
  }

  /// What was closed while less was known is looked at once more before all is called explored.
  [[nodiscard]] bool reopenClosed() {
    const std::size_t known = request.map->freeVoxels() + request.map->occupiedVoxels();
    constexpr double kWorthALook = 1.01;
    const auto before = static_cast<double>(memory.reopened_at_voxels);
    if (static_cast<double>(known) < kWorthALook * before) return false;
    memory.reopened_at_voxels = known;
    bool is_any_open = memory.scouting.barren() > 0;
    memory.scouting.forget();
    ReachabilityGraph& graph = memory.growth.graph();
    for (const VertexId vertex : graph.vertices()) {
      VertexLabel& label = graph.update(vertex);
      if (label.closed_because.empty()) continue;
      label.closed_because.clear();
      label.is_explored = false;
      is_any_open = true;
    }
    return is_any_open;
  }

  void reportNothingLeft(const ExplorationTurn& turn) {
    const ReachabilityGraph& graph = memory.growth.graph();
    bool is_over_budget = false;
    for (const VertexId vertex : graph.vertices()) {
      const VertexLabel& label = graph.labelOf(vertex);
      is_over_budget = is_over_budget || (label.is_over_budget && !label.closed_because.empty());
      if (!label.closed_because.empty())
        result.remaining.push_back(
            {graph.graph().position(vertex), label.best_gain_m3, label.closed_because});
    }
    if (is_over_budget) {
      result.status = PlanStatus::kBudgetSaysHome;
      result.reason = "something is left, but the endurance allows none of it and the way home";
    } else if (turn.samples() == 0 && !result.remaining.empty() &&
               graph.graph().vertexCount() == 1) {
      result.status = PlanStatus::kNoPath;
      result.reason = "hemmed in: no place beside the frontier around the start is free";
    } else {
      result.status = PlanStatus::kNothingToGain;
      result.reason = result.remaining.empty()
                          ? "no frontier is left at any vertex of the reachability graph"
                          : "no frontier is left that can be reached and is worth it; " +
                                std::to_string(result.remaining.size()) + " vertices keep some";
    }
  }

  void goHome() {
    const Polyline way = knownWayHome();
    if (!way.empty()) return finishHome(space.shortened(way, params.shortcut_length_max_m));
    const auto answer =
        space.navigate(root, request.home.position, "home", navigation::TreeDetail::kLeaveOut);
    if (answer.status == navigation::NavigationStatus::kOk) return finishHome(toLine(answer.path));
    result.status = PlanStatus::kNoPath;
    result.reason = "no free way home is left in the reachability graph, and " + answer.reason;
  }

  /// The shortest free way along the graph, from here or from where the path that led here passes
  /// it; empty if there is none.
  [[nodiscard]] Polyline knownWayHome() {
    Polyline shortest;
    double least_m = std::numeric_limits<double>::infinity();
    Polyline back;
    for (const Eigen::Vector3d& place : placesBackAlongProposal()) {
      back.push_back(place);
      if (graph::lengthOf(back) >= least_m) break;
      Polyline way = back;
      const Polyline along = wayHomeFrom(place);
      way.insert(way.end(), along.begin(), along.end());
      const bool is_home = !along.empty() && (along.back() - request.home.position).norm() < 1e-6 &&
                           graph::lengthOf(way) < least_m && space.isFree(way);
      if (!is_home) continue;
      least_m = graph::lengthOf(way);
      shortest = std::move(way);
    }
    return shortest;
  }

  /// Here, and if the last path ends here, places along it back to its start, corners included.
  [[nodiscard]] Polyline placesBackAlongProposal() const {
    const bool ends_here =
        memory.proposal && (memory.proposal->path.back().position - root).norm() < kThere_m;
    if (!ends_here) return {root};
    const Polyline corners = toLine(reversed(memory.proposal->path));
    Polyline places{root};
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const Polyline leg = graph::resampled({corners[i - 1], corners[i]}, params.range_m);
      places.insert(places.end(), leg.begin() + 1, leg.end());
    }
    return places;
  }

  /// From a place near a vertex that a free straight way leads to, along the graph.
  [[nodiscard]] Polyline wayHomeFrom(const Eigen::Vector3d& from) {
    GraphGrowth& growth = memory.growth;
    constexpr int kTried = 8;
    int tried = 0;
    for (const VertexId vertex : growth.graph().graph().findWithin(from, 2.0 * params.range_m)) {
      if (++tried > kTried) break;
      if (!space.free().isFree(from, growth.graph().graph().position(vertex))) continue;
      Polyline way = growth.freeWay(vertex, ReachabilityGraph::home(), space);
      if (!way.empty()) return way.insert(way.begin(), from), way;
    }
    return {};
  }

  void finishHome(const Polyline& way) { result = homeResult(request, root, way, result.stats); }

  void fillStats() {
    const graph::SpatialGraph& graph = memory.growth.graph().graph();
    result.stats.global_vertices = static_cast<int>(graph.vertexCount());
    result.stats.global_edges = static_cast<int>(graph.edgeCount());
    result.stats.frontiers = static_cast<int>(planner.view_.frontier().count());
    result.stats.gain_threshold = params.gain_min_m3;
  }

  static constexpr double kThere_m = 1e-3;
  static constexpr double kShareLeft = 0.5;  // of what a target promised that makes it worth having
  static constexpr int kWaysHomeMax = 3;     // that the motion planner looks for in one plan
  int ways_home = 0;
};

InformedPlanner::InformedPlanner(const InformedParams& params, const RobotModel& robot,
                                 double resolution_m)
    : Remembering(InformedMemory(params.resolvedFor(robot))),
      params_(params.resolvedFor(robot)),
      robot_(robot),
      view_(robot, resolution_m, viewParams(params_)),
      navigator_(navigationParams(params_)),
      boxes_(robot.box_m) {
  require(kindOf(robot) == RobotKind::kAerial, "InformedPlanner: for robots that fly");
}

PlanResult InformedPlanner::doPlan(const PlanRequest& request) {
  const Stopwatch watch;
  view_.look(request.map);
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.noteOutcome();
  search.growGraph();
  if (!search.fliesOn()) search.explore();
  search.fillStats();
  search.result.stats.total_ms = watch.milliseconds();
  return remembering(std::move(search.result), std::move(search.memory));
}

PlanResult InformedPlanner::doPlanHome(const PlanRequest& request) {
  const Stopwatch watch;
  view_.look(request.map);
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.goHome();
  search.fillStats();
  search.result.stats.total_ms = watch.milliseconds();
  return std::move(search.result);
}

PlannerGraph InformedPlanner::graph() const {
  return {{search_layer_, samples_layer_, memory().growth.graph().layer()}};
}

void InformedPlanner::restore(const PlannerGraph& graph) {
  for (const GraphLayer& layer : graph.layers)
    if (layer.name == "reachability") memory().growth.restore(layer);
}

}  // namespace spelunk::planners::informed
