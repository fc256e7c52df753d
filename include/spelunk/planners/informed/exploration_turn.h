#pragma once

#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "spelunk/planners/informed/candidates.h"
#include "spelunk/planners/informed/frontier_survey.h"
#include "spelunk/planners/informed/graph_growth.h"

namespace spelunk::planners::informed {

/// What a turn decided on.
struct Choice {
  Candidate candidate;
  PathKind kind = PathKind::kLocal;
};

/// One turn of the exploration manager (Akbari 2021, section VII, Alg. 1, lines 5 to 10): where to
/// sample, and the best of what was sampled. Lives for one plan.
class ExplorationTurn {
 public:
  ExplorationTurn(GraphGrowth& growth, const FrontierSurvey& survey, CandidateJudge& judge, Rng rng,
                  std::function<bool(const Candidate&)> fits_budget,
                  std::function<bool(graph::VertexId)> scout,
                  std::function<std::optional<Candidate>()> approach);

  /// The best affordable candidate: of the neighbourhood of `current` if that has any, else of the
  /// nearest vertices that have, else of vertices that `scout` adds; or, where that is worth more
  /// for its way, the `approach` to frontier seen from afar. Vertices all of whose frontier
  /// was looked at in vain are closed with the reason. None if nothing is left.
  [[nodiscard]] std::optional<Choice> chooseFrom(graph::VertexId current);

  [[nodiscard]] int samples() const { return samples_; }
  [[nodiscard]] GraphLayer samplesLayer() const;
  void fill(PlanStats& stats) const;

 private:
  struct Draw {
    graph::VertexId vertex{};
    int count = 0;
  };
  [[nodiscard]] std::optional<Candidate> chooseFar(graph::VertexId current);
  [[nodiscard]] std::vector<Draw> neighbourhoodOf(graph::VertexId current) const;
  [[nodiscard]] std::vector<Draw> nextRanked(graph::VertexId current) const;
  [[nodiscard]] std::optional<Candidate> tryAll(const std::vector<Draw>& draws);
  [[nodiscard]] std::optional<Candidate> tryOnce(const std::vector<Draw>& draws);
  void close(graph::VertexId vertex, const Refusals& refusals);

  GraphGrowth& growth_;
  const FrontierSurvey& survey_;
  CandidateJudge& judge_;
  Rng rng_;
  std::function<bool(const Candidate&)> fits_budget_;
  std::function<bool(graph::VertexId)> scout_;
  std::function<std::optional<Candidate>()> approach_;
  std::vector<Candidate> seen_;
  BarrenVoxels barren_;
  std::vector<Eigen::Vector3d> vain_;  ///< Places that need not be sampled again in this turn.
  int round_ = 0;
  int samples_ = 0;
  int infeasible_ = 0;
  int unaffordable_ = 0;  ///< Candidates so far.
  Refusals last_refusals_;
  std::set<graph::VertexId> over_budget_;  ///< Vertices with samples there is no time for.
};

}  // namespace spelunk::planners::informed
