#include "spelunk/planners/gbplanner/global_search.h"

#include <set>

#include "spelunk/planners/gbplanner/exploration_gain.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::VertexId;

/// State of Alg. 3 for one call; its functions are the steps.
struct Search {
  GlobalGraph& global;
  const GlobalQuery& query;
  const FreeSpace& space;
  const GbPlannerParams& params;
  graph::ShortestPaths from_current;
  graph::ShortestPaths from_home;
  std::set<VertexId> evaluated{};
  std::set<VertexId> refused{};
  GlobalPlan plan{};

  void closeTried(const TriedTargets& tried) {
    for (Frontier& frontier : global.frontiers()) {
      if (!frontier.isOpen()) continue;
      if (const auto why = tried.findRefusal(global.graph().position(frontier.vertex)))
        frontier.closed_because = *why;
    }
  }

  /// The open frontier with the greatest gain by eq. (2); counts those that cannot be gone to.
  Frontier* findBest() {
    Frontier* best = nullptr;
    plan.best = 0.0;
    plan.out_of_budget = 0;
    plan.unreachable = 0;
    for (Frontier& frontier : global.frontiers()) {
      if (!frontier.isOpen()) continue;
      if (!from_current.reaches(frontier.vertex) || refused.count(frontier.vertex) > 0) {
        ++plan.unreachable;
        continue;
      }
      const double gain = gainOf(frontier);
      if (gain <= 0.0) ++plan.out_of_budget;
      if (gain <= plan.best) continue;
      plan.best = gain;
      best = &frontier;
    }
    return best;
  }

  /// Whether the frontier is still worth it; its gain is up to date afterwards.
  bool confirm(Frontier& frontier) {
    if (evaluated.insert(frontier.vertex).second)
      frontier.gain_m3 = query.gain_at(global.graph().position(frontier.vertex));
    return frontier.gain_m3 >= params.frontier_gain_m3;
  }

  bool findPath(const Frontier& frontier) {
    plan.path = global.findFreePath(query.current, frontier.vertex, space);
    if (plan.path.size() < 2) {
      plan.path.clear();
      refused.insert(frontier.vertex);
      return false;
    }
    plan.target = plan.path.back();
    plan.gain_m3 = frontier.gain_m3;
    return true;
  }

  /// Alg. 3: the best frontier that holds what it promises.
  void choose() {
    while (Frontier* best = findBest()) {
      const double promised = best->gain_m3;
      if (!confirm(*best)) {
        global.dropFrontiersBelow(params.frontier_gain_m3);
        continue;
      }
      constexpr double kAsGood = 0.8;  // a frontier that lost more has to compete again
      if (best->gain_m3 < kAsGood * promised) continue;
      if (findPath(*best)) return;
    }
  }

 private:
  [[nodiscard]] double gainOf(const Frontier& frontier) const {
    const double distance = from_current.distanceTo(frontier.vertex);
    const double back = from_home.distanceTo(frontier.vertex);
    const double time = explorationTime(query.remaining_s, eta(distance), eta(back));
    return globalExplorationGain(time, frontier.gain_m3, distance, params.global_distance_weight);
  }
  [[nodiscard]] double eta(double length_m) const {
    return estimatedTime(length_m, query.speed_mps, params.eta_factor);
  }
};

}  // namespace

GlobalPlan planGlobally(GlobalGraph& global, const GlobalQuery& query, const FreeSpace& space,
                        const TriedTargets& tried, const GbPlannerParams& params) {
  Search search{global,
                query,
                space,
                params,
                graph::shortestPaths(global.graph(), query.current),
                graph::shortestPaths(global.graph(), GlobalGraph::home())};
  search.closeTried(tried);
  search.choose();
  return std::move(search.plan);
}

}  // namespace spelunk::planners::gbplanner
