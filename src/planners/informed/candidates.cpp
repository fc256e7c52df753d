#include "spelunk/planners/informed/candidates.h"

#include <algorithm>

#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/visits.h"

namespace spelunk::planners::informed {

namespace {

constexpr double kHere_m = 0.3;  // the robot looks from there anyway

}  // namespace

double CandidateJudge::gainAt(const Eigen::Vector3d& place) const {
  return view.seenFrom(place, request.pose.yaw, request.bounds).unknown_m3;
}

bool CandidateJudge::isWorthIt(Candidate& candidate, double& bits, Refusals& refusals) const {
  if ((candidate.sample.place - root).norm() < kHere_m) {
    ++refusals.gainless;
    return false;
  }
  if (wasVisited(request.trail, candidate.sample.place, params.visited_radius_m)) {
    ++refusals.gainless;
    return false;
  }
  if (const auto refusal = tried.findRefusal(candidate.sample.place)) {
    ++refusals.tried;
    refusals.tried_why = *refusal;
    return false;
  }
  const map::VolumetricGain seen =
      view.seenFrom(candidate.sample.place, request.pose.yaw, request.bounds);
  bits = entropyOf(seen, params);
  candidate.gain_m3 = seen.unknown_m3;
  refusals.best_gain_m3 = std::max(refusals.best_gain_m3, seen.unknown_m3);
  if (seen.unknown_m3 >= params.gain_min_m3) return true;
  ++refusals.gainless;
  return false;
}

bool CandidateJudge::findWay(Candidate& candidate) const {
  graph::Polyline way = way_to_vertex(candidate.sample.vertex);
  const Eigen::Vector3d from = way.empty() ? root : way.back();
  const Eigen::Vector3d& to = candidate.sample.place;
  const std::string stream =
      std::to_string(to.x()) + "/" + std::to_string(to.y()) + "/" + std::to_string(to.z());
  navigation::NavigationAnswer answer =
      space.navigate(from, to, stream, navigation::TreeDetail::kKeep);
  if (answer.status != navigation::NavigationStatus::kOk) return false;
  const graph::Polyline end = toLine(answer.path);
  if (way.empty()) {
    candidate.way = end;
  } else {
    way.insert(way.end(), end.begin() + 1, end.end());
    candidate.way = space.shortened(way, params.shortcut_length_max_m);
  }
  candidate.trees = std::move(answer.trees);
  return space.isFree(candidate.way);
}

std::vector<Candidate> CandidateJudge::judge(const std::vector<FrontierSample>& samples,
                                             Refusals& refusals) const {
  std::vector<Candidate> candidates;
  for (const FrontierSample& sample : samples) {
    if (!is_in_reach(sample.place)) {
      refusals.over_budget.insert(sample.vertex);
      refusals.vain.push_back(sample.place);
      continue;
    }
    Candidate candidate;
    candidate.sample = sample;
    UtilityTerms terms;
    if (!isWorthIt(candidate, terms.entropy_end_bits, refusals)) {
      refusals.vain.push_back(sample.place);
      continue;
    }
    if (!findWay(candidate)) {
      ++refusals.unreachable;
      refusals.vain.push_back(sample.place);
      continue;
    }
    terms.length_m = candidate.whole_way_m = graph::lengthOf(candidate.way);
    if (terms.length_m > way_max_m) {
      ++refusals.far;
      continue;
    }
    terms.entropy_way_bits = entropyAlong(candidate.way, view, request.bounds, params);
    terms.clearance_m =
        FrontierView::clearanceAt(*request.map, sample.place, params.clearance_max_m);
    terms.region = region;
    candidate.log_utility = logUtility(terms, params);
    candidates.push_back(std::move(candidate));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.log_utility > b.log_utility; });
  return candidates;
}

}  // namespace spelunk::planners::informed
