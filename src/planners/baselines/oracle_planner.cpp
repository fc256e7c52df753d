#include "spelunk/planners/baselines/oracle_planner.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "spelunk/common/contract.h"
#include "spelunk/common/stopwatch.h"
#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_place.h"
#include "spelunk/planners/shared/free_start.h"
#include "spelunk/planners/shared/known_space.h"

namespace spelunk::planners::baselines {
namespace {

using graph::Polyline;

/// Ways to later points of the tour tried when the next one cannot be reached.
constexpr int kWaysTried = 12;
constexpr int kWayIterations = 2000;

/// So many times the distance that counts as reached may be left out of a tour.
constexpr double kSkipped = 3.0;

/// Where a point of the tour is not known to be free, places this near to it serve as well.
constexpr double kPlaceReach_m = 2.4;
constexpr double kPlaceStep_m = 0.6;

navigation::NavigationParams navigationParams() {
  navigation::NavigationParams navigation;
  navigation.iterations = kWayIterations;
  return navigation;
}

std::optional<Eigen::Vector3d> pointIn(const std::string& line) {
  std::istringstream stream(line);
  Eigen::Vector3d point;
  char first = ' ';
  char second = ' ';
  stream >> point.x() >> first >> point.y() >> second >> point.z();
  if (stream.fail() || first != ',' || second != ',' || !point.allFinite()) return std::nullopt;
  std::string rest;
  stream >> rest;
  return rest.empty() ? std::optional(point) : std::nullopt;
}

}  // namespace

Polyline readTour(const std::string& path) {
  std::ifstream file(path);
  if (path.empty() || !file)
    throw OutsideError("oracle.tour '" + path +
                       "' cannot be read: scripts/best_possible makes one for a world");
  Polyline tour;
  std::string line;
  std::getline(file, line);  // headline
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    const auto point = pointIn(line);
    if (!point)
      throw OutsideError(path + ": line " + std::to_string(number) +
                         ": not a point of a tour: write x,y,z in metres");
    tour.push_back(*point);
  }
  if (tour.size() < 2) throw OutsideError(path + ": a tour needs two points or more");
  return tour;
}

/// State shared by the steps of one plan.
struct OraclePlanner::Search {
  OraclePlanner& planner;
  const PlanRequest& request;
  OracleMemory memory;  ///< A copy: what it learns counts if the plan is taken.
  KnownSpace space;
  PlanResult result{};
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  Polyline line{};

  Search(OraclePlanner& owner, const PlanRequest& asked)
      : planner(owner),
        request(asked),
        memory(owner.recall(asked)),
        space(asked, owner.robot_, owner.navigator_, owner.boxes_) {}

  [[nodiscard]] const Polyline& tour() const { return planner.tour_; }

  [[nodiscard]] bool findRoot() {
    const StartCheck start = checkStart(request, space.free());
    if (!start.root) return result = refusedStart(start), false;
    root = *start.root;
    memory.trail.follow(request, root, space.free());
    line = {root};
    return true;
  }

  /// A point counts as reached once the robot is near it or one a little later; what is farther on
  /// may be the end of a detour that is still to be flown.
  void notePassed() {
    double arc_m = 0.0;
    for (std::size_t i = memory.next; i < tour().size(); ++i) {
      if (i > memory.next) arc_m += (tour()[i] - tour()[i - 1]).norm();
      if (arc_m > kSkipped * planner.params_.reached_m) break;
      if (isNear(tour()[i])) memory.next = i + 1;
    }
  }

  /// Twice as far above or below is near: much the same is seen from there.
  [[nodiscard]] bool isNear(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d gap = (point - root).cwiseAbs();
    return gap.head<2>().norm() <= planner.params_.reached_m &&
           gap.z() <= 2.0 * planner.params_.reached_m;
  }

  /// To the next point of the tour, else to the first one behind it that a way leads to.
  void joinTour() {
    int ways = 0;
    for (std::size_t i = memory.next; i < tour().size() && line.size() == 1 && ways < kWaysTried;
         i += 1 + (i - memory.next) / 8) {  // farther and farther apart
      ++result.stats.samples;
      if (space.free().isFree(root, tour()[i])) {
        line.push_back(tour()[i]);
      } else if (const auto place = placeAt(tour()[i]); place && !isNear(*place)) {
        ++ways;
        const auto answer = space.navigate(root, *place, "tour/" + std::to_string(i),
                                           navigation::TreeDetail::kLeaveOut);
        if (answer.status == navigation::NavigationStatus::kOk) line = toLine(answer.path);
      }
      if (line.size() > 1) memory.next = i;
    }
  }

  /// A free place for a point: itself, at the robot's height, or near it.
  [[nodiscard]] std::optional<Eigen::Vector3d> placeAt(const Eigen::Vector3d& point) const {
    if (space.free().at(point) == Rejection::kNone) return point;
    const Eigen::Vector3d level(point.x(), point.y(), root.z());
    if (space.free().at(level) == Rejection::kNone) return level;
    return PlaceFinder(kPlaceReach_m, kPlaceStep_m).find(point, space.free());
  }

  /// Along the tour as far as it is free and in sight.
  void followTour() {
    double length_m = graph::lengthOf(line);
    for (std::size_t i = memory.next + 1; i < tour().size(); ++i) {
      length_m += (tour()[i] - line.back()).norm();
      if (length_m > planner.params_.look_ahead_m) break;
      if (!space.free().isFree(line.back(), tour()[i])) break;
      line.push_back(tour()[i]);
    }
  }

  void propose() {
    line = space.shortened(line, planner.params_.shortcut_length_max_m);
    memory.trail.expect(line, space.free());
    result.status = PlanStatus::kOk;
    result.path = pathFrom(request.pose, root, line);
    result.stats.vertices = static_cast<int>(line.size());
    result.stats.best_gain = metresLeft();
    result.reason = "along the tour, " + std::to_string(std::lround(metresLeft())) + " m are left";
  }

  [[nodiscard]] double metresLeft() const {
    double metres = 0.0;
    for (std::size_t i = memory.next + 1; i < tour().size(); ++i)
      metres += (tour()[i] - tour()[i - 1]).norm();
    return metres;
  }

  void follow() {
    notePassed();
    joinTour();
    if (line.size() > 1) {
      followTour();
      return propose();
    }
    const bool is_at_end = memory.next == tour().size();
    result.status = is_at_end ? PlanStatus::kNothingToGain : PlanStatus::kNoPath;
    result.reason =
        is_at_end ? "the tour is at its end" : "no free way leads to the next points of the tour";
  }

  void goHome() {
    result = homeResult(request, root, memory.trail.findWay(space.free()), result.stats);
  }
};

OraclePlanner::OraclePlanner(const OracleParams& params, Polyline tour, const RobotModel& robot)
    : Remembering(OracleMemory{}),
      params_(params),
      tour_(std::move(tour)),
      robot_(robot),
      navigator_(navigationParams()),
      boxes_(robot.box_m) {
  require(tour_.size() >= 2, "OraclePlanner: a tour needs two points or more");
}

PlanResult OraclePlanner::doPlan(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.follow();
  search.result.stats.total_ms = watch.milliseconds();
  return remembering(std::move(search.result), std::move(search.memory));
}

PlanResult OraclePlanner::doPlanHome(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.goHome();
  search.result.stats.total_ms = watch.milliseconds();
  return std::move(search.result);
}

PlannerGraph OraclePlanner::graph() const {
  GraphLayer layer{"tour", {}, {}};
  for (std::size_t i = memory().next; i < tour_.size(); ++i) {
    layer.vertices.push_back({tour_[i], 0.0, false});
    const auto number = static_cast<std::uint32_t>(layer.vertices.size() - 1);
    if (number > 0) layer.edges.emplace_back(number - 1, number);
  }
  return {{layer, memory().trail.layer()}};
}

void OraclePlanner::restore(const PlannerGraph& graph) {
  for (const GraphLayer& layer : graph.layers)
    if (layer.name == "trail") memory().trail.restore(layer);
}

}  // namespace spelunk::planners::baselines
