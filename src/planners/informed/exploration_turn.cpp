#include "spelunk/planners/informed/exploration_turn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spelunk::planners::informed {

using graph::VertexId;

namespace {

constexpr double kNeighbourWay = 3.0;  // times d_max: frontier behind a wall is no neighbour
constexpr int kUnaffordableMax = 30;   // candidates; what is farther is not affordable either

}  // namespace

ExplorationTurn::ExplorationTurn(GraphGrowth& growth, const FrontierSurvey& survey,
                                 CandidateJudge& judge, Rng rng,
                                 std::function<bool(const Candidate&)> fits_budget,
                                 std::function<bool(graph::VertexId)> scout,
                                 std::function<std::optional<Candidate>()> approach)
    : growth_(growth),
      survey_(survey),
      judge_(judge),
      rng_(rng),
      fits_budget_(std::move(fits_budget)),
      scout_(std::move(scout)),
      approach_(std::move(approach)) {}

std::optional<Choice> ExplorationTurn::chooseFrom(VertexId current) {
  judge_.way_to_vertex = [](VertexId) { return graph::Polyline{}; };
  judge_.way_max_m = kNeighbourWay * judge_.params.range_m;
  if (auto candidate = tryAll(neighbourhoodOf(current)))
    return Choice{std::move(*candidate), PathKind::kLocal};
  judge_.way_max_m = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d& here = growth_.graph().graph().position(current);
  judge_.way_to_vertex = [&, current](VertexId vertex) {
    if (vertex == current) return graph::Polyline{};
    graph::Polyline way = growth_.freeWay(current, vertex, judge_.space);
    if (!way.empty() && (here - judge_.root).norm() > 0.0) way.insert(way.begin(), judge_.root);
    return way;
  };
  // Far frontier counts too, or all that is near and hardly worth it would come before it.
  static_cast<void>(scout_(current));
  auto far = chooseFar(current);
  auto approach = approach_();
  const auto worth = [&](const Candidate& candidate) {
    return worthOf(candidate.gain_m3, candidate.whole_way_m, judge_.params);
  };
  if (approach && fits_budget_(*approach) && (!far || worth(*approach) > worth(*far)))
    far = std::move(approach);
  if (!far) return std::nullopt;
  return Choice{std::move(*far), PathKind::kReposition};
}

std::optional<Candidate> ExplorationTurn::chooseFar(VertexId current) {
  do {
    for (auto draws = nextRanked(current); !draws.empty(); draws = nextRanked(current))
      if (auto candidate = tryAll(draws)) return candidate;
  } while (scout_(current));
  return std::nullopt;
}

/// The same number of samples from the vertex itself and each of its neighbours.
std::vector<ExplorationTurn::Draw> ExplorationTurn::neighbourhoodOf(VertexId current) const {
  const ReachabilityGraph& graph = growth_.graph();
  std::vector<Draw> draws;
  const auto add = [&](VertexId vertex) {
    if (!graph.labelOf(vertex).is_explored)
      draws.push_back({vertex, judge_.params.samples_a_vertex});
  };
  add(current);
  for (const graph::Neighbour& neighbour : graph.graph().neighbours(current)) add(neighbour.id);
  return draws;
}

/// Eq. (5): the nearest get most samples.
std::vector<ExplorationTurn::Draw> ExplorationTurn::nextRanked(VertexId current) const {
  constexpr double kAgainstOne = 3.0;  // a ranked vertex stands for a whole neighbourhood
  std::vector<Draw> draws;
  double count = kAgainstOne * judge_.params.samples_a_vertex;
  for (const RankedVertex& ranked : growth_.graph().rank(current)) {
    if (static_cast<int>(draws.size()) >= judge_.params.ranked_vertices) break;
    draws.push_back({ranked.vertex, static_cast<int>(std::ceil(count))});
    count *= judge_.params.ranked_rate;
  }
  return draws;
}

/// First a few samples of each; if none will do, every voxel; what fails then is closed.
std::optional<Candidate> ExplorationTurn::tryAll(const std::vector<Draw>& draws) {
  if (draws.empty()) return std::nullopt;
  if (auto candidate = tryOnce(draws)) return candidate;
  for (const Draw& draw : draws) {
    if (auto candidate = tryOnce({{draw.vertex, FrontierSampler::kAll}})) return candidate;
    close(draw.vertex, last_refusals_);
  }
  return std::nullopt;
}

std::optional<Candidate> ExplorationTurn::tryOnce(const std::vector<Draw>& draws) {
  last_refusals_ = {};
  if (unaffordable_ >= kUnaffordableMax) {
    for (const Draw& draw : draws) over_budget_.insert(draw.vertex);
    return std::nullopt;
  }
  FrontierSampler sampler(judge_.view.credible(), judge_.space, judge_.params,
                          rng_.fork("round/" + std::to_string(round_++)), barren_, vain_);
  std::vector<FrontierSample> samples;
  for (const Draw& draw : draws) {
    if (judge_.region == Region::kBranch) survey_.measure(growth_.graph(), draw.vertex);
    const auto drawn =
        sampler.draw(draw.vertex, growth_.graph().labelOf(draw.vertex), draw.count, judge_.region);
    samples.insert(samples.end(), drawn.begin(), drawn.end());
  }
  samples_ += static_cast<int>(samples.size());
  infeasible_ += sampler.infeasible();
  std::vector<Candidate> candidates = judge_.judge(samples, last_refusals_);
  over_budget_.insert(last_refusals_.over_budget.begin(), last_refusals_.over_budget.end());
  vain_.insert(vain_.end(), last_refusals_.vain.begin(), last_refusals_.vain.end());
  seen_.insert(seen_.end(), candidates.begin(), candidates.end());
  for (Candidate& candidate : candidates) {
    if (fits_budget_(candidate)) return std::move(candidate);
    ++unaffordable_;
    over_budget_.insert(candidate.sample.vertex);
    vain_.push_back(candidate.sample.place);  // there will not be more time in this plan
  }
  return std::nullopt;
}

void ExplorationTurn::close(VertexId vertex, const Refusals& refusals) {
  if (refusals.far > 0) return;
  const bool is_over_budget = over_budget_.count(vertex) > 0;
  VertexLabel& label = growth_.graph().update(vertex);
  label.is_explored = true;
  label.is_over_budget = is_over_budget;
  label.closed_from = judge_.root;
  label.best_gain_m3 = refusals.best_gain_m3;
  label.closed_voxels.clear();
  for (const FrontierVoxel& voxel : label.frontier) label.closed_voxels.push_back(voxel.voxel);
  if (is_over_budget)
    label.closed_because = "no time for it and the way home";
  else if (refusals.unreachable > 0)
    label.closed_because = "no free way leads to its frontier";
  else if (refusals.tried > 0)
    label.closed_because = refusals.tried_why;
  else if (refusals.gainless > 0 || !vain_.empty())
    label.closed_because = "too little can be seen from beside its frontier";
  else
    label.closed_because = "no place beside its frontier is free for the robot";
}

GraphLayer ExplorationTurn::samplesLayer() const {
  GraphLayer layer{"samples", {}, {}};
  if (seen_.empty()) return layer;
  double best = seen_.front().log_utility;
  for (const Candidate& candidate : seen_) best = std::max(best, candidate.log_utility);
  for (const Candidate& candidate : seen_)
    layer.vertices.push_back(
        {candidate.sample.place, std::exp(candidate.log_utility - best), false});
  return layer;
}

void ExplorationTurn::fill(PlanStats& stats) const {
  stats.samples = samples_ + infeasible_;
  stats.rejected_occupied = infeasible_;
  stats.vertices = samples_;
}

}  // namespace spelunk::planners::informed
