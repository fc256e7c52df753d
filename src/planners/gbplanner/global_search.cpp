#include "spelunk/planners/gbplanner/global_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

  /// How a frontier would be gone to.
  struct Leg {
    double length_m;
    double saved_m;  ///< By a presumed way; 0 on a known one.
  };

  [[nodiscard]] Leg legTo(const Frontier& frontier) const {
    const double known = refused.count(frontier.vertex) > 0
                             ? std::numeric_limits<double>::infinity()
                             : from_current.distanceTo(frontier.vertex);
    if (query.presumed == nullptr) return {known, 0.0};
    const double presumed = query.presumed->distanceTo(global.graph().position(frontier.vertex));
    if (presumed + params.presumed_saving_m < known) return {presumed, known - presumed};
    return {known, 0.0};
  }

  /// The open frontier with the greatest gain by eq. (2); counts those that cannot be gone to.
  Frontier* findBest() {
    Frontier* best = nullptr;
    plan.best = 0.0;
    plan.out_of_budget = 0;
    plan.unreachable = 0;
    for (Frontier& frontier : global.frontiers()) {
      if (!frontier.isOpen() || frontier.gain_m3 < query.frontier_gain_m3) continue;
      const int counted = frontier.gain_m3 >= params.frontier_gain_m3 ? 1 : 0;
      const Leg leg = legTo(frontier);
      if (!std::isfinite(leg.length_m)) {
        plan.unreachable += counted;
        continue;
      }
      const double gain = gainOf(frontier, leg);
      if (gain <= 0.0) plan.out_of_budget += counted;
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
    return frontier.gain_m3 >= query.frontier_gain_m3;
  }

  /// The way itself is found piece by piece, by the caller.
  bool takePresumedWay(const Frontier& frontier) {
    plan.saved_m = legTo(frontier).saved_m;
    if (plan.saved_m <= 0.0) return false;
    plan.target = global.graph().position(frontier.vertex);
    plan.gain_m3 = frontier.gain_m3;
    return true;
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
        global.dropFrontiersBelow(kMinorShare * params.frontier_gain_m3);
        continue;
      }
      constexpr double kAsGood = 0.8;  // a frontier that lost more has to compete again
      if (best->gain_m3 < kAsGood * promised) continue;
      if (takePresumedWay(*best) || findPath(*best)) return;
    }
  }

 private:
  [[nodiscard]] double gainOf(const Frontier& frontier, const Leg& leg) const {
    const double back = std::min(from_home.distanceTo(frontier.vertex),
                                 leg.length_m + from_current.distanceTo(GlobalGraph::home()));
    const double time = explorationTime(query.remaining_s, eta(leg.length_m), eta(back));
    return globalExplorationGain(time, believedGain(frontier.gain_m3, params.gain_threshold_m3),
                                 leg.length_m, params.global_distance_weight);
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
