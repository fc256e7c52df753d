#include "spelunk/planners/gbplanner/gb_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spelunk/common/stopwatch.h"
#include "spelunk/graph/a_star.h"
#include "spelunk/planners/gbplanner/exploration_gain.h"
#include "spelunk/planners/gbplanner/global_search.h"
#include "spelunk/planners/gbplanner/improve_path.h"
#include "spelunk/planners/gbplanner/plan_view.h"
#include "spelunk/planners/gbplanner/presumed_piece.h"
#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_start.h"
#include "spelunk/planners/shared/visits.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::Polyline;
using graph::VertexId;

/// As far as a robot gets in some plans; upwards as much as a map grows on the way.
const Eigen::Vector3d kWindowSlack_m(15.0, 15.0, 1.0);

GlobalGraphLimits limitsFrom(const GbPlannerParams& params) {
  GlobalGraphLimits limits;
  limits.connect_radius_m = params.global_radius_m;
  limits.frontier_spacing_m = params.frontier_spacing_m;
  return limits;
}

}  // namespace

GbMemory::GbMemory(const GbPlannerParams& params)
    : global(limitsFrom(params)),
      tried(params.tried_radius_m),
      trail_known_until_s(-std::numeric_limits<double>::infinity()) {}

/// State shared by the steps of one plan.
struct GbPlanner::Search {
  GbPlanner& planner;
  const PlanRequest& request;
  GbMemory memory;  ///< A copy: what it learns counts if the plan is taken.
  PlanView view;
  PlanResult result{};
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  VertexId current{};
  std::optional<GbMemory::Proposal> previous{};
  LocalPlan local{};
  double way_home_m = 0.0;
  std::optional<map::PresumedWays> presumed{};  ///< From the root.

  Search(GbPlanner& owner, const PlanRequest& asked)
      : planner(owner),
        request(asked),
        memory(owner.recall(asked)),
        view(asked, owner.robot_, owner.params_, owner.evaluator_, {owner.body_, owner.roomy_},
             owner.window_) {}

  [[nodiscard]] std::shared_ptr<const map::FrozenMap> credible() const {
    return planner.credible_.of(request.map);
  }

  void noteOutcome() {
    previous = std::exchange(memory.proposal, std::nullopt);
    if (previous)
      memory.tried.note(previous->target, memory.last.outcome, memory.last.reason, request.time_s);
    memory.tried.age(request.time_s);
  }

  void joinGlobalGraph() {
    if (memory.global.isEmpty()) memory.global.setHome(request.home.position);
    for (const StampedPose& stamped : request.trail) {
      if (stamped.time_s <= memory.trail_known_until_s) continue;
      memory.global.addFlown(stamped.pose.position, view.space());
      memory.trail_known_until_s = stamped.time_s;
    }
    current = memory.global.addPoint(root, view.space());
    if (memory.checked_zones != request.zones_revision) {
      memory.global.forgetChecksNear(root, std::numeric_limits<double>::infinity());
      memory.checked_zones = request.zones_revision;
    }
    if (memory.checked_map != request.map) {
      memory.global.forgetChecksNear(root, longestRange(planner.robot_));
      memory.checked_map = request.map;
    }
  }

  void measureWayHome() {
    way_home_m =
        graph::findShortestPath(memory.global.graph(), current, GlobalGraph::home()).length;
  }

  void planLocally(const GbPlannerParams& params) {
    const bool flies_on = previous && previous->kind == PathKind::kLocal &&
                          memory.last.outcome == PathOutcome::kReplaced;
    LocalContext context{memory.tried, std::nullopt, std::isfinite(way_home_m) ? way_home_m : 0.0};
    if (flies_on) context.previous_target = previous->end;
    local =
        gbplanner::planLocally(request, view, root, context, planner.robot_, params, result.stats);
  }

  /// Before anything is called explored: a denser graph, and less gain is enough.
  void planLocallyOnceMore() {
    constexpr int kDenser = 5;
    GbPlannerParams closer = planner.params_;
    closer.max_vertices *= kDenser;
    closer.max_edges *= kDenser;
    closer.gain_threshold_m3 *= kMinorShare;
    planLocally(closer);
  }

  /// Alg. 4, and the periodic re-evaluation of frontiers within the local box.
  void extendGlobalGraph() {
    const Stopwatch watch;
    reevaluateFrontiers();
    if (!local.best.empty()) memory.global.addPath(local.best, view.space());
    for (const PrincipalPath& principal : local.principals) {
      if (memory.global.hasFrontierNear(principal.path.back(), principal.gain_m3)) continue;
      const VertexId leaf = memory.global.addPath(principal.path, view.space());
      memory.global.markFrontier(leaf, principal.gain_m3);
    }
    result.stats.global_ms = watch.milliseconds();
  }

  void reevaluateFrontiers() {
    for (Frontier& frontier : memory.global.frontiers()) {
      const Eigen::Vector3d& at = memory.global.graph().position(frontier.vertex);
      if (frontier.isOpen() && view.localBox().contains(at))
        frontier.gain_m3 = view.gainAt(at, request.pose.yaw);
    }
    memory.global.dropFrontiersBelow(kMinorShare * planner.params_.frontier_gain_m3);
  }

  /// Local completion: what promised to be worth coming here has kept its promise or not.
  void closeFrontiersHere() {
    for (Frontier& frontier : memory.global.frontiers()) {
      const Eigen::Vector3d& at = memory.global.graph().position(frontier.vertex);
      if (frontier.isOpen() && (at - root).norm() < planner.params_.tried_radius_m)
        frontier.closed_because = "been there: no path from it reaches the gain threshold";
    }
  }

  void followLocalPath() {
    const Polyline cut = toLine(slice(toPath(local.best, {root, request.pose.yaw}), 0.0,
                                      planner.params_.local_length_max_m));
    finish(improved(cut), PathKind::kLocal, local.best.back());
    result.reason =
        "local path, " + std::to_string(std::lround(local.best_gain_m3)) + " m3 expected along it";
  }

  /// Alg. 3.
  GlobalPlan planGlobally(double frontier_gain_m3, bool with_presumed_ways) {
    const Stopwatch watch;
    GlobalQuery query{current, request.remaining_s, planner.robot_.speed_max_mps, frontier_gain_m3,
                      [this](const Eigen::Vector3d& at) {
                        if (wasVisited(request.trail, at, planner.params_.visited_radius_m))
                          return 0.0;
                        return gainAnywhere(request, *credible(), planner.evaluator_, at,
                                            request.pose.yaw);
                      }};
    if (with_presumed_ways && !presumed)
      presumed.emplace(planner.credible_.of(request.map), root, kPresumedReach_m, memory.closed);
    if (with_presumed_ways) query.presumed = &*presumed;
    GlobalPlan plan =
        gbplanner::planGlobally(memory.global, query, view.space(), memory.tried, planner.params_);
    result.stats.global_ms += watch.milliseconds();
    return plan;
  }

  /// The next piece of the presumed way to the plan's target; false if it cannot be flown.
  bool advance(const GlobalPlan& plan) {
    const map::PresumedWays to_target(planner.credible_.of(request.map), *plan.target,
                                      kPresumedReach_m, memory.closed);
    const Polyline piece = pieceTowards(local.local, to_target, memory.tried);
    if (piece.empty()) return false;
    memory.global.addPath(piece, view.space());
    finish(improved(piece), PathKind::kReposition, piece.back());
    const auto whole = [](double number) { return std::to_string(std::lround(number)); };
    result.reason =
        "through a gap of the map to a frontier of " + whole(plan.gain_m3) + " m3, " +
        whole(to_target.distanceTo(root)) + " m away, " +
        (std::isfinite(plan.saved_m) ? whole(plan.saved_m) + " m less than the known way"
                                     : std::string("where no known way leads"));
    return true;
  }

  /// No piece of the presumed way can be flown: none leads through here again.
  void closeWayAhead(const GlobalPlan& plan) {
    if (const auto place = placeAhead(presumed->wayTo(*plan.target)))
      memory.closed.push_back(*place);
    presumed.reset();
  }

  /// Goes to the best frontier, on a known way or piece by piece on a presumed one.
  bool repositions(double frontier_gain_m3, GlobalPlan& plan) {
    constexpr int kAttempts = 4;
    // What was seen from afar says nothing of a footing: robots with legs stay on known ways.
    const int attempts = kindOf(planner.robot_) == RobotKind::kAerial ? kAttempts : 0;
    for (int k = 0; k <= attempts; ++k) {
      plan = planGlobally(frontier_gain_m3, k < attempts);
      if (plan.saved_m <= 0.0) break;
      if (advance(plan)) return true;
      closeWayAhead(plan);
    }
    if (plan.path.empty()) return false;
    reposition(plan);
    return true;
  }

  void reposition(const GlobalPlan& plan) {
    finish(improved(fromRoot(plan.path)), PathKind::kReposition, plan.path.back());
    result.reason = "reposition to a frontier of " + std::to_string(std::lround(plan.gain_m3)) +
                    " m3, " + std::to_string(std::lround(lengthOf(result.path))) + " m away";
  }

  /// The local planner; on local completion the global one; if that has nothing either, both once
  /// more, looking closer.
  void choose() {
    if (!local.best.empty()) return followLocalPath();
    closeFrontiersHere();
    GlobalPlan plan;
    if (repositions(planner.params_.frontier_gain_m3, plan)) return;
    planLocallyOnceMore();
    extendGlobalGraph();
    if (!local.best.empty()) return followLocalPath();
    if (repositions(kMinorShare * planner.params_.frontier_gain_m3, plan)) return;
    reportNothingLeft(plan);
  }

  void goHome() {
    Polyline way = fromRoot(memory.global.findFreePath(current, GlobalGraph::home(), view.space()));
    if (way.empty()) {
      result.status = PlanStatus::kNoPath;
      result.reason = "no free path home is left in the global graph";
      return;
    }
    const GbPlannerParams& params = planner.params_;
    way = shortened(way, view.space(), params.shortcut_length_max_m);
    result = homeResult(request, root, way, result.stats);
  }

  /// `way` from the root on; a path from a merged vertex begins up to its radius beside it.
  [[nodiscard]] Polyline fromRoot(Polyline way) const {
    constexpr double kSamePlace = 1e-6;
    if (!way.empty() && (way.front() - root).norm() > kSamePlace) way.insert(way.begin(), root);
    return way;
  }

  void reportNothingLeft(const GlobalPlan& plan) {
    listRemaining();
    constexpr int kHemmedIn = 3;  // a graph of fewer vertices has not left the start
    if (result.stats.vertices < kHemmedIn) {
      result.status = PlanStatus::kNoPath;
      result.reason = "hemmed in: none of " + std::to_string(result.stats.samples) +
                      " samples could be joined to the start through known free space";
    } else if (local.is_over_budget || plan.out_of_budget > 0) {
      result.status = PlanStatus::kBudgetSaysHome;
      result.reason = "something is left, but the endurance allows none of it and the way home";
    } else if (plan.unreachable > 0) {
      result.status = PlanStatus::kNoPath;
      result.reason = "frontiers are left, but no free path leads to any of them";
    } else {
      result.status = PlanStatus::kNothingToGain;
      result.reason = "nothing reachable above g_e is left";
    }
  }

  void listRemaining() {
    for (const Frontier& frontier : memory.global.frontiers()) {
      const std::string why = frontier.isOpen() ? "no time for it and the way home, or no free path"
                                                : frontier.closed_because;
      result.remaining.push_back(
          {memory.global.graph().position(frontier.vertex), frontier.gain_m3, why});
    }
  }

  Polyline improved(const Polyline& line) {
    const Stopwatch watch;
    const GbPlannerParams& params = planner.params_;
    Polyline better = improvedPath(
        line, view.space(), *request.map,
        {params.shortcut_length_max_m, params.prune_length_m, params.inflation_radius_m});
    result.stats.improve_ms += watch.milliseconds();
    return better;
  }

  /// `target`: where the path was to lead before it was cut and improved.
  void finish(const Polyline& line, PathKind kind, const Eigen::Vector3d& target) {
    result.status = PlanStatus::kOk;
    result.kind = kind;
    result.path = pathFrom(request.pose, root, line);
    memory.proposal = GbMemory::Proposal{kind, target, line.back()};
    if (kind == PathKind::kLocal) memory.global.addPath(line, view.space());
  }

  void fillStats() {
    result.stats.global_vertices = static_cast<int>(memory.global.graph().vertexCount());
    result.stats.global_edges = static_cast<int>(memory.global.graph().edgeCount());
    result.stats.frontiers = static_cast<int>(memory.global.frontiers().size());
    result.stats.best_gain = local.best_gain_m3;
    result.stats.gain_threshold = planner.params_.gain_threshold_m3;
  }

  [[nodiscard]] GraphLayer localLayer() const {
    GraphLayer layer{"local", {}, {}};
    const graph::SpatialGraph& graph = local.local.graph;
    for (std::size_t i = 0; i < graph.vertexCount(); ++i) {
      layer.vertices.push_back(
          {graph.position(VertexId{static_cast<std::uint32_t>(i)}), local.gains_m3[i], false});
    }
    for (const auto& [a, b] : graph.edges())
      layer.edges.emplace_back(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
    return layer;
  }
};

GbPlanner::GbPlanner(const GbPlannerParams& params, const RobotModel& robot, double resolution_m)
    : Remembering(GbMemory(params)),
      params_(params),
      robot_(robot),
      evaluator_(robot.sensor_models, resolution_m,
                 params.count_cones ? map::GainCounting::kCone : map::GainCounting::kPerRay,
                 params.cone_depth_m),
      credible_({params.closing_height_m, params.growth_m}),
      window_(kWindowSlack_m),
      body_(robot.box_m),
      roomy_(robot.box_m + 2.0 * params.safety_margin_m) {}

PlanResult GbPlanner::doPlan(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  search.view.prepareGains(search.credible());
  search.result.stats.window_ms = watch.milliseconds();
  const StartCheck start = checkStart(request, search.view.space());
  if (!start.root) return refusedStart(start);
  search.root = *start.root;
  search.noteOutcome();
  search.joinGlobalGraph();
  search.measureWayHome();
  search.planLocally(params_);
  search.extendGlobalGraph();
  search.choose();
  search.fillStats();
  search.result.stats.total_ms = watch.milliseconds();
  local_layer_ = search.localLayer();
  return remembering(std::move(search.result), std::move(search.memory));
}

PlanResult GbPlanner::doPlanHome(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  const StartCheck start = checkStart(request, search.view.space());
  if (!start.root) return refusedStart(start);
  search.root = *start.root;
  search.joinGlobalGraph();
  search.goHome();
  search.fillStats();
  search.result.stats.total_ms = watch.milliseconds();
  return std::move(search.result);
}

PlannerGraph GbPlanner::graph() const { return {{local_layer_, memory().global.layer()}}; }

void GbPlanner::restore(const PlannerGraph& graph) {
  for (const GraphLayer& layer : graph.layers) {
    if (layer.name == "global") memory().global.restore(layer);
  }
}

}  // namespace spelunk::planners::gbplanner
