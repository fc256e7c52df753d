#include "spelunk/planners/gbplanner/local_graph.h"

#include <algorithm>
#include <optional>

#include "spelunk/common/stopwatch.h"
#include "spelunk/planners/shared/rejection_count.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::VertexId;

constexpr int kSamplesBetweenClockReads = 64;

struct Expansion {
  LocalGraph& local;
  const FreeSpace& space;
  const FreeSpace& roomy;
  const GbPlannerParams& params;
  PlanStats& stats;
  bool shortens_steps = false;  ///< Blocked steps are tried again at a part of their length.

  [[nodiscard]] bool isFull() const {
    return local.graph.vertexCount() >= static_cast<std::size_t>(params.max_vertices) ||
           local.graph.edgeCount() >= static_cast<std::size_t>(params.max_edges);
  }

  void tryPoint(Eigen::Vector3d point) {
    const VertexId nearest = *local.graph.findNearest(point);
    const Eigen::Vector3d from = local.graph.position(nearest);
    const double gap = (point - from).norm();
    if (gap < params.edge_length_min_m) return;
    if (gap > params.edge_length_max_m)
      point = from + (point - from) * (params.edge_length_max_m / gap);
    const auto placed = space.placed(point, from);
    if (!placed) return count(Rejection::kTooSteep, stats);
    point = *placed;
    const Rejection at_point = space.at(point);
    if (at_point != Rejection::kNone) return count(at_point, stats);
    if (!space.isFree(from, point)) {
      const auto nearer = shortened(from, point);
      if (!nearer) {
        ++stats.rejected_unconnected;
        return;
      }
      point = *nearer;
    }
    const VertexId added = local.graph.addVertex(point);
    local.graph.addEdge(nearest, added, weightOf(from, point));
    connect(added);
  }

  /// The end of the longest free half, quarter, ... of a step, apart from what the graph has.
  [[nodiscard]] std::optional<Eigen::Vector3d> shortened(const Eigen::Vector3d& from,
                                                         const Eigen::Vector3d& to) const {
    constexpr double kShortestStep_m = 0.3;
    if (!shortens_steps) return std::nullopt;
    for (Eigen::Vector3d step = 0.5 * (to - from); step.norm() >= kShortestStep_m; step *= 0.5) {
      const auto placed = space.placed(from + step, from);
      if (!placed || !space.isFree(from, *placed)) continue;
      const Eigen::Vector3d point = *placed;
      const Eigen::Vector3d nearest = local.graph.position(*local.graph.findNearest(point));
      if ((point - nearest).norm() < kShortestStep_m) return std::nullopt;
      return point;
    }
    return std::nullopt;
  }

  [[nodiscard]] double weightOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return (a - b).norm() * (roomy.isFree(a, b) ? 1.0 : params.tightness_cost);
  }

  void connect(VertexId added) {
    const Eigen::Vector3d point = local.graph.position(added);
    int tried = 0;
    for (const VertexId near : local.graph.findWithin(point, params.connection_radius_m)) {
      if (near == added || local.graph.hasEdge(near, added)) continue;
      if (++tried > params.connections_max) return;
      const Eigen::Vector3d& other = local.graph.position(near);
      if (space.isFree(point, other)) local.graph.addEdge(near, added, weightOf(point, other));
    }
  }
};

}  // namespace

LocalGraph buildLocalGraph(const Eigen::Vector3d& root, const map::FreeVoxels& sampler,
                           const FreeSpace& space, const FreeSpace& roomy,
                           const GbPlannerParams& params, const PlanBudget& budget, Rng rng,
                           PlanStats& stats) {
  const Stopwatch watch;
  LocalGraph local;
  local.root = local.graph.addVertex(root);
  Expansion expansion{local, space, roomy, params, stats};
  const int samples_max = stats.samples + budget.iterations;
  while (!expansion.isFull() && stats.samples < samples_max) {
    if (stats.samples % kSamplesBetweenClockReads == 0 &&
        watch.milliseconds() > budget.seconds * 1e3) {
      break;
    }
    // A graph that is not full by now grows in a tight place, where long straight steps fail.
    constexpr int kTightAfterShare = 5;
    expansion.shortens_steps =
        stats.samples > samples_max - budget.iterations + budget.iterations / kTightAfterShare;
    ++stats.samples;
    const auto sample = sampler.draw(rng);
    if (!sample) break;
    expansion.tryPoint(*sample);
  }
  stats.vertices = static_cast<int>(local.graph.vertexCount());
  stats.edges = static_cast<int>(local.graph.edgeCount());
  return local;
}

}  // namespace spelunk::planners::gbplanner
