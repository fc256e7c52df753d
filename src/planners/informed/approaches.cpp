#include "spelunk/planners/informed/approaches.h"

#include <algorithm>
#include <cmath>

#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_place.h"

namespace spelunk::planners::informed {
namespace {

constexpr int kTargetsMax = 30;  // whose gain is counted, nearest first
constexpr double kSameTarget_m = 4.0;
constexpr int kAttempts = 4;          // ways that turn out closed, in one plan
constexpr double kBesideWay_m = 1.0;  // where places are looked for
constexpr double kPlaceStep_m = 0.25;
constexpr double kGapMax_m = 2.0;  // along the way without a place; farther on is unknown
constexpr int kEnds = 3;           // of a piece, tried from the farthest on

/// The free places along a presumed way up to where there are none any more, farthest first.
std::vector<Eigen::Vector3d> placesAlong(const graph::Polyline& way, const KnownSpace& space) {
  const PlaceFinder beside(kBesideWay_m, kPlaceStep_m);
  std::vector<Eigen::Vector3d> places;
  double since_m = 0.0;
  for (std::size_t i = 1; i < way.size() && since_m <= kGapMax_m; ++i) {
    since_m += (way[i] - way[i - 1]).norm();
    const auto place = beside.findRoomy(way[i], space);
    if (!place) continue;
    since_m = 0.0;
    places.push_back(*place);
  }
  std::reverse(places.begin(), places.end());
  return places;
}

/// A known way from the root to a place along the presumed way, the farthest that has one and is
/// progress; empty if there is none.
graph::Polyline pieceOf(const graph::Polyline& way, const map::PresumedWays& ways,
                        const CandidateJudge& judge) {
  double last_m = 0.0;
  int tried = 0;
  for (const Eigen::Vector3d& place : placesAlong(way, judge.space)) {
    const double along_m = ways.distanceTo(place);
    if (along_m < kPresumedProgress_m || tried >= kEnds) break;
    const bool is_next = tried == 0 || along_m < last_m - kPresumedProgress_m;
    if (!is_next || judge.tried.findRefusal(place)) continue;
    ++tried;
    last_m = along_m;
    const auto answer = judge.space.navigate(judge.root, place, "approach/" + std::to_string(tried),
                                             navigation::TreeDetail::kLeaveOut);
    if (answer.status != navigation::NavigationStatus::kOk) continue;
    graph::Polyline piece = toLine(answer.path);
    if (judge.space.isFree(piece)) return piece;
  }
  return {};
}

}  // namespace

std::optional<Approaches::Target> Approaches::bestOf(const std::vector<Eigen::Vector3d>& frontier,
                                                     const map::PresumedWays& ways,
                                                     const CandidateJudge& judge) {
  std::vector<Target> targets;
  for (const Eigen::Vector3d& place : frontier) {
    const double way_m = ways.distanceTo(place);
    if (std::isfinite(way_m) && way_m >= kPresumedProgress_m && judge.is_in_reach(place))
      targets.push_back({place, 0.0, way_m});
  }
  std::stable_sort(targets.begin(), targets.end(),
                   [](const Target& a, const Target& b) { return a.way_m < b.way_m; });
  std::vector<Target> counted;
  for (Target& target : targets) {
    if (static_cast<int>(counted.size()) >= kTargetsMax) break;
    const bool is_same = std::any_of(counted.begin(), counted.end(), [&](const Target& other) {
      return (other.place - target.place).norm() < kSameTarget_m;
    });
    if (is_same) continue;
    target.gain_m3 = judge.gainAt(target.place);
    counted.push_back(target);
  }
  std::optional<Target> best;
  for (const Target& target : counted)
    if (target.gain_m3 >= judge.params.gain_min_m3 &&
        (!best || worthOf(target.gain_m3, target.way_m, judge.params) >
                      worthOf(best->gain_m3, best->way_m, judge.params)))
      best = target;
  return best;
}

std::optional<Candidate> Approaches::find(const std::vector<Eigen::Vector3d>& frontier,
                                          const CandidateJudge& judge) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const map::PresumedWays ways(judge.view.sharedCredible(), judge.root, kPresumedReach_m,
                                 closed_);
    const auto target = bestOf(frontier, ways, judge);
    if (!target) return std::nullopt;
    const graph::Polyline way = ways.wayTo(target->place);
    graph::Polyline piece = pieceOf(way, ways, judge);
    if (!piece.empty()) {
      Candidate candidate;
      candidate.sample = {graph::VertexId{}, target->place, piece.back()};
      candidate.way = std::move(piece);
      candidate.gain_m3 = target->gain_m3;
      candidate.whole_way_m = target->way_m;
      candidate.is_approach = true;
      return candidate;
    }
    if (const auto ahead = placeAhead(way)) closed_.push_back(*ahead);
  }
  return std::nullopt;
}

}  // namespace spelunk::planners::informed
