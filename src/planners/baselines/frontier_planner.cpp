#include "spelunk/planners/baselines/frontier_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr double kPlaceReach_m = 1.5;
constexpr double kPlaceStep_m = 0.3;
constexpr double kWideReach_m = 6.0;
constexpr double kWideStep_m = 0.6;
constexpr double kClusterSide_m = 2.0;
constexpr double kReached_m = 0.5;
constexpr double kShareLeft = 0.5;  // of what a target promised that still makes it worth having

/// Places that need not be looked at again in this plan.
class Crossed {
 public:
  void add(const Eigen::Vector3d& place, double radius_m) { spots_.push_back({place, radius_m}); }
  [[nodiscard]] bool covers(const Eigen::Vector3d& place) const {
    return std::any_of(spots_.begin(), spots_.end(), [&](const Spot& spot) {
      return (spot.place - place).squaredNorm() < spot.radius_m * spot.radius_m;
    });
  }

 private:
  struct Spot {
    Eigen::Vector3d place;
    double radius_m;
  };
  std::vector<Spot> spots_;
};

}  // namespace

/// State shared by the steps of one plan.
struct FrontierPlanner::Search {
  struct Candidate {
    Eigen::Vector3d voxel;
    Polyline way;
    double gain_m3 = 0.0;
    double score = 0.0;  ///< Higher is better.
    navigation::NavigationTrees trees;
  };

  FrontierPlanner& planner;
  const PlanRequest& request;
  FrontierMemory memory;  ///< A copy: what it learns counts if the plan is taken.
  const FrontierPlannerParams& params;
  KnownSpace space;
  KnownSpace ways_home;
  PlanResult result{};
  Eigen::Vector3d root = Eigen::Vector3d::Zero();
  std::vector<Candidate> candidates{};
  std::optional<Target> previous{};
  int unreachable = 0;
  int given_up = 0;
  int infeasible = 0;
  bool is_over_budget = false;
  /// The shortest affordable way so far: what lies farther off even straight cannot be nearest.
  double nearest_m = std::numeric_limits<double>::infinity();

  Search(FrontierPlanner& owner, const PlanRequest& asked)
      : planner(owner),
        request(asked),
        memory(owner.recall(asked)),
        params(owner.params_),
        space(asked, owner.robot_, owner.navigator_, owner.boxes_),
        ways_home(asked, owner.robot_, owner.home_navigator_, owner.boxes_) {}

  [[nodiscard]] bool ranksByUtility() const { return planner.preference_ == Preference::kUtility; }

  [[nodiscard]] bool findRoot() {
    const StartCheck start = checkStart(request, space.free());
    if (!start.root) return result = refusedStart(start), false;
    root = *start.root;
    memory.trail.follow(request, root, space.free());
    return true;
  }

  [[nodiscard]] double gainAt(const Eigen::Vector3d& place) const {
    return planner.view_.seenFrom(place, request.pose.yaw, request.bounds).unknown_m3;
  }

  [[nodiscard]] bool isCluster(const Eigen::Vector3d& voxel) const {
    const auto box = boxAround(voxel, Eigen::Vector3d::Constant(kClusterSide_m));
    return planner.view_.frontier().countWithin(box) >=
           static_cast<std::size_t>(params.frontier_voxels_min);
  }

  /// Whether more than slivers of unknown space would be seen from a place.
  [[nodiscard]] bool seesEnough(const Eigen::Vector3d& place) const {
    return params.gain_min_m3 <= 0.0 || gainAt(place) >= params.gain_min_m3;
  }

  /// Whether a target is still worth what it was when it was chosen.
  [[nodiscard]] bool keepsPromise(const Eigen::Vector3d& voxel, const Eigen::Vector3d& place,
                                  double promised_m3) const {
    if (!ranksByUtility()) return isCluster(voxel) && seesEnough(place);
    return gainAt(place) >= std::max(kShareLeft * promised_m3, params.gain_min_m3);
  }

  void noteOutcome() {
    previous = std::exchange(memory.target, std::nullopt);
    if (previous)
      memory.tried.note(previous->path.back().position, memory.last.outcome, memory.last.reason,
                        request.time_s);
    memory.tried.age(request.time_s);
    for (const Visit& visit : memory.visits.takeMade(request, memory.last.outcome))
      if (keepsPromise(visit.voxel, visit.place, visit.gain_m3))
        memory.tried.giveUp(visit.place, "been there: what it promised cannot be seen from it");
  }

  [[nodiscard]] bool fliesOn() {
    if (!previous || memory.last.outcome != PathOutcome::kReplaced) return false;
    const PathProjection at = project(previous->path, request.pose.position);
    Path rest = slice(previous->path, at.arc_m, lengthOf(previous->path));
    constexpr double kBeside_m = 0.3;
    if (at.distance_m > kBeside_m || lengthOf(rest) < kReached_m) return false;
    if (!keepsPromise(previous->voxel, rest.back().position, previous->gain_m3) ||
        !fitsBudget(lengthOf(rest), rest.back().position))
      return false;
    rest.front() = request.pose;
    if (!space.isFree(toLine(rest))) return false;
    result.stats.vertices = static_cast<int>(rest.size());
    propose({previous->voxel, std::move(rest), previous->gain_m3});
    result.reason = "on to the frontier of before";
    return true;
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> voxelsInOrder() const {
    std::vector<std::pair<double, Eigen::Vector3d>> keyed;
    Rng rng = request.rng.fork("frontier");
    for (const map::VoxelIndex& voxel : planner.view_.frontier().within(request.bounds)) {
      const Eigen::Vector3d centre = planner.view_.credible().centreOf(voxel);
      keyed.emplace_back(ranksByUtility() ? rng.uniform() : (centre - root).norm(), centre);
    }
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Eigen::Vector3d> voxels;
    for (const auto& [key, centre] : keyed) voxels.push_back(centre);
    return voxels;
  }

  /// What a sensor of few rows sees far away has no free place right beside it: where nothing else
  /// is left, places farther from their frontier do.
  void collectCandidates() {
    collectCandidates(kPlaceReach_m, kPlaceStep_m);
    if (candidates.empty()) collectCandidates(kWideReach_m, kWideStep_m);
  }

  void collectCandidates(double reach_m, double step_m) {
    const PlaceFinder places(reach_m, step_m);
    Crossed crossed;
    for (const Eigen::Vector3d& voxel : voxelsInOrder()) {
      if (static_cast<int>(candidates.size()) >= params.candidates) break;
      if (!ranksByUtility() && (voxel - root).norm() - reach_m >= nearest_m) break;
      if (crossed.covers(voxel) || !isCluster(voxel)) continue;
      ++result.stats.samples;
      const auto place = places.findRoomy(voxel, space);
      if (!place) {
        ++infeasible;
        crossed.add(voxel, 0.5 * params.sample_spacing_m);
        continue;
      }
      crossed.add(voxel, params.sample_spacing_m);
      consider(voxel, *place);
    }
    result.stats.rejected_unknown = infeasible;
    result.stats.rejected_unconnected = unreachable;
  }

  void consider(const Eigen::Vector3d& voxel, const Eigen::Vector3d& place) {
    constexpr double kHere_m = 0.3;  // the robot looks from there anyway
    if ((place - root).norm() < kHere_m || memory.tried.findRefusal(place)) {
      ++given_up;
      return;
    }
    if (!ranksByUtility() && (place - root).norm() >= nearest_m) return;
    Candidate candidate{voxel, {}, 0.0, 0.0, {}};
    if (ranksByUtility()) candidate.gain_m3 = gainAt(place);
    if (ranksByUtility() ? candidate.gain_m3 < params.gain_min_m3 : !seesEnough(place)) return;
    const std::string stream = std::to_string(result.stats.samples);
    auto answer = space.navigate(root, place, stream, navigation::TreeDetail::kKeep);
    if (answer.status != navigation::NavigationStatus::kOk) {
      ++unreachable;
      memory.tried.note(place, PathOutcome::kBlocked, "no free way leads to it", request.time_s);
      return;
    }
    candidate.way = toLine(answer.path);
    candidate.trees = std::move(answer.trees);
    const double length = graph::lengthOf(candidate.way);
    constexpr double kAtOnce_s = 1.0;  // a place beside the robot would be worth infinitely much
    candidate.score =
        ranksByUtility() ? candidate.gain_m3 / (kAtOnce_s + travelTime(length)) : -length;
    if (length < nearest_m && fitsBudget(length, place)) nearest_m = length;
    candidates.push_back(std::move(candidate));
  }

  [[nodiscard]] double travelTime(double metres) const {
    return params.eta_factor * metres / planner.robot_.speed_max_mps;
  }

  [[nodiscard]] bool fitsBudget(double length_m, const Eigen::Vector3d& end) {
    const double straight_m = (request.home.position - end).norm();
    if (travelTime(length_m + straight_m) > request.remaining_s) return false;
    if (travelTime(2.0 * length_m + memory.trail.metres()) <= request.remaining_s) return true;
    return travelTime(length_m + metresHome(length_m, end)) <= request.remaining_s;
  }

  /// From the end of a way that is `length_m` long.
  [[nodiscard]] double metresHome(double length_m, const Eigen::Vector3d& end) {
    const double back_m = length_m + memory.trail.metres();
    const auto home = ways_home.navigate(end, request.home.position, "home from a target",
                                         navigation::TreeDetail::kLeaveOut);
    return home.status == navigation::NavigationStatus::kOk ? std::min(lengthOf(home.path), back_m)
                                                            : back_m;
  }

  void choose() {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.score > b.score; });
    planner.samples_layer_ = {"samples", {}, {}};
    for (const Candidate& candidate : candidates)
      planner.samples_layer_.vertices.push_back({candidate.way.back(), candidate.gain_m3, false});
    for (const Candidate& candidate : candidates) {
      if (!fitsBudget(graph::lengthOf(candidate.way), candidate.way.back())) {
        is_over_budget = true;
        continue;
      }
      Path path = pathFrom(request.pose, root, candidate.way);
      planner.search_layer_ = {"search", {}, candidate.trees.edges};
      for (const Eigen::Vector3d& vertex : candidate.trees.vertices)
        planner.search_layer_.vertices.push_back({vertex, 0.0, false});
      propose({candidate.voxel, std::move(path), candidate.gain_m3});
      memory.visits.expect(
          {candidate.voxel, candidate.way.back(), candidate.gain_m3, request.time_s});
      result.reason =
          "to a frontier " + std::to_string(std::lround(lengthOf(result.path))) + " m away";
      return;
    }
    reportNothingLeft();
  }

  void propose(Target target) {
    result.status = PlanStatus::kOk;
    result.path = target.path;
    memory.trail.expect(toLine(target.path), space.free());
    constexpr double kNear = 3.0;  // times the range: such a way is flown with its eyes open
    result.kind =
        lengthOf(target.path) < kNear * params.range_m ? PathKind::kLocal : PathKind::kReposition;
    result.stats.best_gain = target.gain_m3;
    result.stats.vertices += static_cast<int>(candidates.size() + result.path.size());
    memory.target = std::move(target);
  }

  void reportNothingLeft() {
    if (is_over_budget) {
      result.status = PlanStatus::kBudgetSaysHome;
      result.reason = "frontiers are left, but the endurance allows none of them and the way home";
    } else if (infeasible > 0 && result.stats.samples == infeasible) {
      result.status = isAloneAtStart() ? PlanStatus::kNoPath : PlanStatus::kNothingToGain;
      result.reason = isAloneAtStart()
                          ? "hemmed in: no place beside the frontier around the start is free"
                          : "no frontier is left that has a free place beside it";
    } else {
      result.status = PlanStatus::kNothingToGain;
      result.reason = "no frontier is left that can be reached and is worth it; " +
                      std::to_string(unreachable) + " unreachable, " + std::to_string(given_up) +
                      " given up";
    }
  }

  /// Whether the robot knows little more than the place it stands in.
  [[nodiscard]] bool isAloneAtStart() const {
    const Eigen::Vector3d known = request.map->knownBounds().size();
    return (known.array() < 2.0 * planner.robot_.box_m.array() + 1.0).all();
  }

  void goHome() {
    constexpr double kShortcut_m = 8.0;
    const Polyline back = space.shortened(memory.trail.findWay(space.free()), kShortcut_m);
    const auto answer =
        ways_home.navigate(root, request.home.position, "home", navigation::TreeDetail::kLeaveOut);
    const bool is_found = answer.status == navigation::NavigationStatus::kOk;
    if (is_found && (back.empty() || lengthOf(answer.path) < graph::lengthOf(back)))
      return finishHome(toLine(answer.path));
    if (!back.empty()) return finishHome(back);
    result.status = PlanStatus::kNoPath;
    result.reason = "no free way home is known: " + answer.reason;
  }

  void finishHome(const Polyline& way) { result = homeResult(request, root, way, result.stats); }
};

FrontierPlanner::FrontierPlanner(const FrontierPlannerParams& params, Preference preference,
                                 const RobotModel& robot, double resolution_m)
    : Remembering(FrontierMemory(params.tried_radius_m)),
      params_(params),
      preference_(preference),
      robot_(robot),
      view_(robot, resolution_m, {params.range_m, {params.closing_height_m, params.growth_m}}),
      navigator_(params.navigation()),
      home_navigator_(params.homeNavigation()),
      boxes_(robot.box_m) {
  require(kindOf(robot) == RobotKind::kAerial, "FrontierPlanner: for robots that fly");
}

PlanResult FrontierPlanner::doPlan(const PlanRequest& request) {
  const Stopwatch watch;
  view_.look(request.map);
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.noteOutcome();
  if (!search.fliesOn()) {
    search.collectCandidates();
    search.choose();
  }
  search.result.stats.frontiers = static_cast<int>(view_.frontier().count());
  if (search.ranksByUtility()) search.result.stats.gain_threshold = params_.gain_min_m3;
  search.result.stats.total_ms = watch.milliseconds();
  return remembering(std::move(search.result), std::move(search.memory));
}

PlanResult FrontierPlanner::doPlanHome(const PlanRequest& request) {
  const Stopwatch watch;
  Search search(*this, request);
  if (!search.findRoot()) return std::move(search.result);
  search.goHome();
  search.result.stats.total_ms = watch.milliseconds();
  return std::move(search.result);
}

PlannerGraph FrontierPlanner::graph() const { return {{search_layer_, samples_layer_}}; }

void FrontierPlanner::restore(const PlannerGraph& /*graph*/) {}

}  // namespace spelunk::planners::baselines
