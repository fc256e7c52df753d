#include "spelunk/planners/gbplanner/local_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "spelunk/common/stopwatch.h"
#include "spelunk/planners/gbplanner/exploration_gain.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::Polyline;
using graph::VertexId;

/// State of Alg. 1 for one call; its functions are the steps.
struct Search {
  const PlanRequest& request;
  PlanView& view;
  const LocalContext& context;
  const RobotModel& robot;
  const GbPlannerParams& params;
  PlanStats& stats;
  LocalPlan plan{};
  std::vector<Polyline> paths{};              // Sigma_L by leaf: positions
  std::vector<std::vector<VertexId>> ways{};  // and vertices

  void buildGraph(const Eigen::Vector3d& root) {
    const Stopwatch watch;
    plan.local = buildLocalGraph(root, map::FreeVoxels(view.map(), view.localBox()), view.space(),
                                 view.roomySpace(), params, request.budget,
                                 request.rng.fork("gbplanner/local_graph"), stats);
    stats.graph_ms = watch.milliseconds();
  }

  void findShortestPaths() {
    const graph::SpatialGraph& graph = plan.local.graph;
    const graph::ShortestPaths shortest = graph::shortestPaths(graph, plan.local.root);
    ways.resize(graph.vertexCount());
    paths.resize(graph.vertexCount());
    for (std::size_t i = 0; i < graph.vertexCount(); ++i) {
      ways[i] = shortest.pathTo(VertexId{static_cast<std::uint32_t>(i)});
      for (const VertexId id : ways[i]) paths[i].push_back(graph.position(id));
    }
  }

  void computeVolumetricGains() {
    const Stopwatch watch;
    plan.gains_m3.resize(paths.size());
    for (const std::size_t i : neighboursInTurn())
      plan.gains_m3[i] = view.gainAt(paths[i].back(), headingAtEnd(paths[i]));
    stats.gain_ms = watch.milliseconds();
  }

  void chooseBestPath() {
    const Eigen::Vector3d exploring = exploringDirection(request, params.direction_window_s);
    double best = 0.0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (!isWorthFlying(i)) continue;
      const double discounted = discountedGainOf(i);
      if (plan.best.empty()) plan.best_gain_m3 = std::max(plan.best_gain_m3, discounted);
      if (discounted < params.gain_threshold_m3) continue;
      const double gain = discounted * similarityTo(exploring, i) * commitmentTo(i);
      if (gain <= best) continue;
      if (!fitsBudget(i)) {
        plan.is_over_budget = true;
        continue;
      }
      best = gain;
      plan.best = paths[i];
      plan.best_gain_m3 = discounted;
    }
  }

  /// Branches that promise a frontier's gain, then those that promise only a share of it: a long
  /// branch of little gain must not stand for a shorter one of much.
  void findPrincipalPaths() {
    addPrincipalPaths(params.frontier_gain_m3, std::numeric_limits<double>::infinity());
    addPrincipalPaths(kMinorShare * params.frontier_gain_m3, params.frontier_gain_m3);
  }

 private:
  /// All vertices, strip by strip: rays of neighbours read the same part of the map, which then
  /// is in the processor's cache.
  [[nodiscard]] std::vector<std::size_t> neighboursInTurn() const {
    constexpr double kStrip_m = 8.0;
    const auto place = [&](std::size_t i) {
      const Eigen::Vector3d& end = paths[i].back();
      return std::make_pair(std::floor(end.y() / kStrip_m), end.x());
    };
    std::vector<std::size_t> order(paths.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
    return order;
  }

  void addPrincipalPaths(double gain_min_m3, double gain_max_m3) {
    std::vector<Polyline> promising;
    std::vector<double> gains;
    for (std::size_t i = 1; i < paths.size(); ++i) {
      const double gain = plan.gains_m3[i];
      if (paths[i].size() < 2 || gain < gain_min_m3 || gain >= gain_max_m3) continue;
      promising.push_back(paths[i]);
      gains.push_back(gain);
    }
    for (const graph::PathCluster& cluster :
         graph::clusterPaths(promising, params.path_spacing_m, params.cluster_distance_m)) {
      plan.principals.push_back({promising[cluster.principal], gains[cluster.principal]});
    }
  }

  [[nodiscard]] double headingAtEnd(const Polyline& path) const {
    if (path.size() < 2) return request.pose.yaw;
    const Eigen::Vector3d step = path.back() - path[path.size() - 2];
    return std::atan2(step.y(), step.x());
  }

  [[nodiscard]] bool isWorthFlying(std::size_t i) const {
    return paths[i].size() > 1 && !context.tried.findRefusal(paths[i].back());
  }

  [[nodiscard]] double discountedGainOf(std::size_t i) const {
    std::vector<double> gains;
    for (const VertexId id : ways[i]) gains.push_back(plan.gains_m3[indexOf(id)]);
    return discountedGain(
        paths[i], gains, params.distance_weight,
        params.count_once ? PathGainCounting::kBestVertex : PathGainCounting::kSum);
  }

  [[nodiscard]] double similarityTo(const Eigen::Vector3d& exploring, std::size_t i) const {
    return similarityFactor(dissimilarity(paths[i], exploring, params.path_spacing_m),
                            params.similarity_weight);
  }

  [[nodiscard]] double commitmentTo(std::size_t i) const {
    constexpr double kSameTarget = 3.0;  // metres between two samples of the same intention
    const bool is_same = context.previous_target &&
                         (paths[i].back() - *context.previous_target).norm() < kSameTarget;
    return is_same ? params.commitment : 1.0;
  }

  [[nodiscard]] bool fitsBudget(std::size_t i) const {
    const double length = graph::lengthOf(paths[i]);
    const double out = estimatedTime(length, robot.speed_max_mps, params.eta_factor);
    const double back =
        estimatedTime(length + context.way_home_m, robot.speed_max_mps, params.eta_factor);
    return explorationTime(request.remaining_s, out, back) > 0.0;
  }
};

}  // namespace

LocalPlan planLocally(const PlanRequest& request, PlanView& view, const Eigen::Vector3d& root,
                      const LocalContext& context, const RobotModel& robot,
                      const GbPlannerParams& params, PlanStats& stats) {
  Search search{request, view, context, robot, params, stats};
  search.buildGraph(root);
  search.findShortestPaths();
  search.computeVolumetricGains();
  search.chooseBestPath();
  search.findPrincipalPaths();
  return std::move(search.plan);
}

}  // namespace spelunk::planners::gbplanner
