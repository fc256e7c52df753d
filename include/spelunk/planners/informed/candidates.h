#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/informed/frontier_sampler.h"
#include "spelunk/planners/informed/informed_params.h"
#include "spelunk/planners/informed/utility.h"
#include "spelunk/planners/shared/known_space.h"
#include "spelunk/planners/shared/tried_targets.h"

namespace spelunk::planners::informed {

/// A frontier sample that can be flown to.
struct Candidate {
  FrontierSample sample;
  graph::Polyline way;       ///< From the root of the plan.
  double whole_way_m = 0.0;  ///< To what it promises.
  bool is_approach = false;  ///< Its way is only the known first piece of the whole one.
  double gain_m3 = 0.0;
  double log_utility = 0.0;
  navigation::NavigationTrees trees;
};

/// Why samples were no candidates.
struct Refusals {
  int tried = 0;
  int gainless = 0;
  int unreachable = 0;
  int far = 0;                            ///< The way is too long for a neighbour.
  std::set<graph::VertexId> over_budget;  ///< With a sample that even straight ways there and home
                                          ///< leave no time for.
  std::vector<Eigen::Vector3d> vain;      ///< Places of those that no later look will like better.
  std::string tried_why;
  double best_gain_m3 = 0.0;  ///< Of those that were not tried before.
};

/// Judges samples: information, motion planning, utility (Akbari 2021, Alg. 1, lines 8 and 9). A
/// view for the duration of one plan.
struct CandidateJudge {
  const PlanRequest& request;
  const FrontierView& view;
  const InformedParams& params;
  const TriedTargets& tried;
  KnownSpace& space;
  Eigen::Vector3d root;
  Region region = Region::kVoid;
  double way_max_m = 1e9;  ///< Longer ways do not count now.
  /// Way from the root to a vertex along the graph, for samples out of the neighbourhood; empty if
  /// the motion planner is to go straight from the root.
  std::function<graph::Polyline(graph::VertexId)> way_to_vertex;

  /// Whether straight ways to a place and from it home would fit the endurance.
  std::function<bool(const Eigen::Vector3d&)> is_in_reach;

  /// Cubic metres of unknown space seen from a place.
  [[nodiscard]] double gainAt(const Eigen::Vector3d& place) const;

  /// The samples that promise enough, were not given up before and that a free way leads to; best
  /// utility first. What is dropped is counted in the refusals, with its place.
  [[nodiscard]] std::vector<Candidate> judge(const std::vector<FrontierSample>& samples,
                                             Refusals& refusals) const;

 private:
  [[nodiscard]] bool isWorthIt(Candidate& candidate, double& bits, Refusals& refusals) const;
  [[nodiscard]] bool findWay(Candidate& candidate) const;
};

}  // namespace spelunk::planners::informed
