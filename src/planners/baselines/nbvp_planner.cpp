#include "spelunk/planners/baselines/nbvp_planner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spelunk/common/stopwatch.h"
#include "spelunk/map/free_voxels.h"
#include "spelunk/planners/baselines/nbvp_tree.h"
#include "spelunk/planners/baselines/tiled_gain.h"
#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_start.h"
#include "spelunk/planners/shared/rejection_count.h"

namespace spelunk::planners::baselines {
namespace {

constexpr int kSamplesBetweenClockReads = 64;
/// As far as the known part grows in some plans.
const Eigen::Vector3d kWindowSlack_m(25.0, 25.0, 1.0);
constexpr double kSamePlace_m = 0.1;  // what is left of a shorter edge is none

AxisAlignedBox everywhere(const map::FrozenMap& map, const AxisAlignedBox& bounds) {
  return intersection(map.knownBounds(), bounds);
}

}  // namespace

/// State shared by the steps of one plan.
struct NbvpPlanner::Search {
  NbvpPlanner& planner;
  const PlanRequest& request;
  NbvpMemory memory;  ///< A copy: what it learns counts if the plan is taken.
  const NbvpParams& params;
  FreeSpace space;
  PlanResult result{};
  Pose root{};
  double way_home_m = 0.0;
  std::optional<NbvpTree> tree{};
  std::optional<TiledGain> gains{};
  std::size_t best = 0;
  bool is_over_budget = false;
  bool is_refused = false;
  Rng rng;

  Search(NbvpPlanner& owner, const PlanRequest& asked)
      : planner(owner),
        request(asked),
        memory(owner.recall(asked)),
        params(owner.params_),
        space([&boxes = owner.boxes_](const Eigen::Vector3d& a,
                                      const Eigen::Vector3d& b) { return boxes.sweep(a, b); },
              owner.robot_.box_m, asked.bounds, asked.zones, groundUnder(*asked.map, owner.robot_)),
        rng(asked.rng.fork("nbvp")) {
    owner.boxes_.use(asked.map);
  }
  Search(const Search&) = delete;  // its free space refers to it
  Search& operator=(const Search&) = delete;

  [[nodiscard]] bool findRoot() {
    const StartCheck start = checkStart(request, space);
    if (!start.root) return result = refusedStart(start), false;
    root = {*start.root, request.pose.yaw};
    return true;
  }

  void noteOutcome() {
    memory.tried.age(request.time_s);
    const Path& branch = memory.branch;
    if (branch.empty()) return;
    memory.tried.note(poseAt(branch, memory.executed_m).position, memory.last.outcome,
                      memory.last.reason, request.time_s);
  }

  void followTrail() {
    memory.trail.follow(request, root.position, space);
    way_home_m = memory.trail.metres();
  }

  /// The root and what is left of the best branch of the last tree, its gains counted anew.
  void plantTree() {
    gains.emplace(planner.credible_.of(request.map), planner.evaluator_, request.bounds,
                  planner.window_);
    tree.emplace(root, params.distance_weight);
    std::size_t last = 0;
    for (const Pose& pose : branchAhead()) {
      const Pose& before = tree->node(last).pose;
      if (distance(before, pose) < kSamePlace_m) continue;
      if (!space.isFree(before.position, pose.position)) break;
      last = add(last, pose);
    }
  }

  /// The nodes of the best branch of the last tree that the robot has not passed yet.
  [[nodiscard]] Path branchAhead() const {
    const Path& branch = memory.branch;
    if (branch.empty()) return {};
    const double passed_m =
        project(slice(branch, 0.0, memory.executed_m), root.position).arc_m + kSamePlace_m;
    Path ahead;
    double arc_m = 0.0;
    for (std::size_t i = 1; i < branch.size(); ++i) {
      arc_m += distance(branch[i - 1], branch[i]);
      if (arc_m > passed_m) ahead.push_back(branch[i]);
    }
    return ahead;
  }

  /// Algorithm 1.
  void growTree() {
    const Stopwatch watch;
    const AxisAlignedBox box = everywhere(*request.map, request.bounds);
    const map::FreeVoxels known(request.map, box);
    while (wantsMore() && result.stats.samples < request.budget.iterations) {
      if (result.stats.samples % kSamplesBetweenClockReads == 0 &&
          watch.milliseconds() > request.budget.seconds * 1e3)
        break;
      ++result.stats.samples;
      const auto sample = params.samples == "box" ? drawnFrom(box) : known.draw(rng);
      if (!sample) break;
      extendTowards(*sample);
    }
    result.stats.vertices = static_cast<int>(tree->size());
    result.stats.edges = result.stats.vertices - 1;
    result.stats.graph_ms = watch.milliseconds();
  }

  [[nodiscard]] std::optional<Eigen::Vector3d> drawnFrom(const AxisAlignedBox& box) {
    if (box.isEmpty()) return std::nullopt;
    const double x = rng.uniform(box.min.x(), box.max.x());
    const double y = rng.uniform(box.min.y(), box.max.y());
    return Eigen::Vector3d(x, y, rng.uniform(box.min.z(), box.max.z()));
  }

  [[nodiscard]] bool wantsMore() const {
    const auto size = static_cast<int>(tree->size());
    return size < params.max_vertices || (best == 0 && size < params.give_up_vertices);
  }

  void extendTowards(Eigen::Vector3d point) {
    const std::size_t nearest = tree->nearestTo(point);
    const Eigen::Vector3d from = tree->node(nearest).pose.position;
    const double gap = (point - from).norm();
    if (gap < params.edge_length_min_m) return;
    point = from + (point - from) * std::min(1.0, params.edge_length_max_m / gap);
    const auto placed = space.placed(point, from);
    if (!placed) return count(Rejection::kTooSteep, result.stats);
    const Rejection rejection = space.along(from, *placed);
    if (rejection != Rejection::kNone) return count(rejection, result.stats);
    add(nearest, {*placed, headingOf(*placed - from)});
  }

  [[nodiscard]] double headingOf(const Eigen::Vector3d& edge) {
    if (!seesAllAround(planner.robot_)) return rng.uniform(-M_PI, M_PI);
    return std::atan2(edge.y(), edge.x());
  }

  std::size_t add(std::size_t parent, const Pose& pose) {
    const Stopwatch watch;
    const double visible = gains->visibleFrom(pose);
    result.stats.gain_ms += watch.milliseconds();
    const std::size_t added = tree->add(parent, pose, visible < params.gain_min_m3 ? 0.0 : visible);
    if (tree->node(added).gain_m3 > tree->node(best).gain_m3 && mayBeBest(added)) best = added;
    return added;
  }

  [[nodiscard]] bool mayBeBest(std::size_t number) {
    if (memory.tried.findRefusal(tree->node(executedOf(number)).pose.position))
      return is_refused = true, false;
    const double metres = tree->node(number).length_m + wayHomeFrom(number);
    const double seconds = params.eta_factor * metres / planner.robot_.speed_max_mps;
    if (seconds > request.remaining_s) return is_over_budget = true, false;
    return true;
  }

  [[nodiscard]] double wayHomeFrom(std::size_t number) const {
    return tree->node(number).length_m + (std::isfinite(way_home_m) ? way_home_m : 0.0);
  }

  /// The end of the first edge of the branch to a node; of what is left of one and the next.
  [[nodiscard]] std::size_t executedOf(std::size_t number) const {
    for (;;) {
      const std::size_t parent = tree->node(number).parent;
      if (parent == 0 || tree->node(parent).length_m < params.edge_length_min_m) return number;
      number = parent;
    }
  }

  void executeFirstEdge() {
    memory.branch.clear();
    if (best == 0) return reportNothingLeft();
    for (const std::size_t number : tree->branchTo(best))
      memory.branch.push_back(tree->node(number).pose);
    memory.executed_m = tree->node(executedOf(best)).length_m;
    memory.trail.expect(toLine(slice(memory.branch, 0.0, memory.executed_m)), space);
    result.status = PlanStatus::kOk;
    result.kind = PathKind::kLocal;
    result.path = {request.pose};
    if (root.position != request.pose.position) result.path.push_back(root);
    for (const std::size_t number : tree->branchTo(executedOf(best)))
      if (number != 0) result.path.push_back(tree->node(number).pose);
    result.stats.best_gain = tree->node(best).gain_m3;
    result.reason = "first of " + std::to_string(memory.branch.size() - 1) + " edges, " +
                    std::to_string(std::lround(result.stats.best_gain)) + " m3 along them";
  }

  void reportNothingLeft() {
    if (tree->size() == 1) {
      result.status = PlanStatus::kNoPath;
      result.reason = "hemmed in: none of " + std::to_string(result.stats.samples) +
                      " samples could be joined to the start through known free space";
    } else if (is_over_budget) {
      result.status = PlanStatus::kBudgetSaysHome;
      result.reason = "something is left, but the endurance allows none of it and the way home";
    } else if (is_refused) {
      result.status = PlanStatus::kNoPath;
      result.reason = "something is left, but the ways to it were tried and given up";
    } else {
      result.status = PlanStatus::kNothingToGain;
      result.reason =
          "none of " + std::to_string(tree->size()) + " nodes in explored space sees anything new";
    }
  }

  void goHome() {
    result = homeResult(request, root.position, memory.trail.findWay(space), result.stats);
  }

  [[nodiscard]] GraphLayer treeLayer() const {
    GraphLayer layer{"tree", {}, {}};
    for (std::size_t i = 0; i < tree->size(); ++i) {
      layer.vertices.push_back({tree->node(i).pose.position, tree->node(i).gain_m3, false});
      if (i > 0)
        layer.edges.emplace_back(static_cast<std::uint32_t>(tree->node(i).parent),
                                 static_cast<std::uint32_t>(i));
    }
    return layer;
  }
};

NbvpPlanner::NbvpPlanner(const NbvpParams& params, const RobotModel& robot, double resolution_m)
    : Remembering(NbvpMemory(params.tried_radius_m)),
      params_(params),
      robot_(robot),
      evaluator_(robot.sensor_models, resolution_m, map::GainCounting::kCone, params.cone_depth_m),
      credible_({params.closing_height_m, params.growth_m}),
      window_(kWindowSlack_m),
      boxes_(robot.box_m) {}

PlanResult NbvpPlanner::doPlan(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.noteOutcome();
  search.followTrail();
  search.plantTree();
  search.growTree();
  search.executeFirstEdge();
  tree_layer_ = search.treeLayer();
  search.result.stats.gain_threshold = params_.gain_min_m3;
  search.result.stats.total_ms = watch.milliseconds();
  return remembering(std::move(search.result), std::move(search.memory));
}

PlanResult NbvpPlanner::doPlanHome(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.followTrail();
  search.goHome();
  search.result.stats.total_ms = watch.milliseconds();
  return std::move(search.result);
}

PlannerGraph NbvpPlanner::graph() const { return {{tree_layer_, memory().trail.layer()}}; }

void NbvpPlanner::restore(const PlannerGraph& graph) {
  for (const GraphLayer& layer : graph.layers)
    if (layer.name == "trail") memory().trail.restore(layer);
}

}  // namespace spelunk::planners::baselines
