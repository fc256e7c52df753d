#include "spelunk/navigation/navigator.h"

#include <algorithm>
#include <cmath>

#include "search_space.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/stopwatch.h"
#include "spelunk/map/free_voxels.h"
#include "spelunk/navigation/swept_path_check.h"
#include "tree_search.h"

namespace spelunk::navigation {
namespace {

enum class Method { kAdaptive, kRrtStar, kPlain, kPlainShort };

constexpr std::pair<const char*, Method> kMethods[] = {{"adaptive", Method::kAdaptive},
                                                       {"rrt_star", Method::kRrtStar},
                                                       {"plain", Method::kPlain},
                                                       {"plain_short", Method::kPlainShort}};

std::optional<Method> methodNamed(const std::string& name) {
  for (const auto& [known, method] : kMethods)
    if (name == known) return method;
  return std::nullopt;
}

/// One way to search, tried in turn.
struct Attempt {
  Unknown unknown;
  Clearance clearance;
};

/// Unknown goals may lie outside everything seen; ways to them need room around the straight line.
constexpr double kRoomAround_m = 5.0;
/// Of the draws where trees may grow in unknown space, so many lie in known space: draws from the
/// whole box hardly ever lead along a gallery.
constexpr double kKnownShare = 0.5;

AxisAlignedBox grown(const AxisAlignedBox& box, double by_m) {
  return {box.min.array() - by_m, box.max.array() + by_m};
}

/// One query; lives for one call.
struct Query {
  Query(const NavigationQuery& asked_query, const NavigationParams& parameters,
        RobotSpaces& robot_spaces)
      : asked(asked_query),
        params(parameters),
        spaces(robot_spaces),
        method(*methodNamed(parameters.method)),
        start(asked.start.position) {}

  NavigationAnswer run() {
    if (!checkGoal() || !checkStart()) return answer;
    const std::vector<Attempt> attempts = attemptsByGoal();
    if (method != Method::kPlain && goStraight(attempts.front())) return answer;
    int left = params.iterations;
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      const int share = i + 1 == attempts.size() ? left : (left + 1) / 2;
      if (share == 0 || secondsLeft() <= 0.0) break;
      if (search(attempts[i], share)) return answer;
      left = params.iterations - answer.iterations;
    }
    return refused(NavigationStatus::kNoPath, noPathReason()), answer;
  }

  void refused(NavigationStatus status, const std::string& reason) {
    answer.status = status;
    answer.reason = reason;
  }

  bool isInZone(const Eigen::Vector3d& place) const {
    return std::any_of(asked.zones.begin(), asked.zones.end(), [&](const NoGoZone& zone) {
      return sweptBoxMeets(zone, place, place, asked.box);
    });
  }

  bool checkGoal() {
    const Eigen::Vector3d& goal = asked.goal.position;
    if (!asked.bounds.contains(goal))
      return refused(NavigationStatus::kOutOfBounds, "the goal lies outside the bounds"), false;
    if (isInZone(goal))
      return refused(NavigationStatus::kNoGo, "the goal lies in a no-go zone"), false;
    if (!spaces.open.isFree(goal))
      return refused(NavigationStatus::kGoalBlocked,
                     "the robot's box at the goal touches an obstacle"),
             false;
    is_goal_known = spaces.known.isFree(goal);
    if (!is_goal_known && asked.region == SearchRegion::kKnown)
      return refused(NavigationStatus::kGoalUnknown, "the goal is not in known free space"), false;
    return true;
  }

  bool checkStart() {
    if (isInZone(start))
      return refused(NavigationStatus::kNoGo, "the start lies in a no-go zone"), false;
    SearchSpace space(asked, start, spaces, Unknown::kClosed, Clearance::kBox);
    const auto place = freePlaceNear(start, space, spaces);
    if (!place)
      return refused(NavigationStatus::kStartBlocked,
                     "the robot's box at the start is not in known free space"),
             false;
    start = *place;
    return true;
  }

  /// Whether the search avoids unknown space and obstacles where it can.
  bool staysInKnown() const { return method == Method::kAdaptive || method == Method::kRrtStar; }

  std::vector<Attempt> attemptsByGoal() const {
    std::vector<Attempt> attempts;
    const auto add = [&](Unknown unknown) {
      if (staysInKnown() && params.safe_distance_m > 0.0)
        attempts.push_back({unknown, Clearance::kSafeDistance});
      attempts.push_back({unknown, Clearance::kBox});
    };
    if (asked.region == SearchRegion::kKnown || (staysInKnown() && is_goal_known))
      add(Unknown::kClosed);
    if (asked.region != SearchRegion::kKnown) add(Unknown::kOpen);
    return attempts;
  }

  bool goStraight(const Attempt& attempt) {
    SearchSpace space(asked, start, spaces, attempt.unknown, attempt.clearance);
    if (!space.isFree(start, asked.goal.position)) return false;
    accept({start, asked.goal.position}, space, "the straight line is free");
    return true;
  }

  bool search(const Attempt& attempt, int iterations) {
    SearchSpace space(asked, start, spaces, attempt.unknown, attempt.clearance);
    TreeTask task;
    task.kind = method == Method::kRrtStar ? TreeKind::kStar : TreeKind::kConnect;
    task.start = start;
    task.goal = asked.goal.position;
    task.region = searchRegion(attempt);
    task.extension_m = params.extension_m;
    task.iterations = iterations;
    task.time_limit_s = secondsLeft();
    task.line = method == Method::kPlain ? TreeLine::kAsFound : TreeLine::kSimplified;
    std::optional<map::FreeVoxels> known;
    if (staysInKnown()) known.emplace(asked.map, task.region);
    const double known_share = attempt.unknown == Unknown::kClosed ? 1.0 : kKnownShare;
    task.draw = [&](Rng& rng) {
      return drawn(known && rng.uniform() < known_share ? &*known : nullptr, task.region, rng);
    };
    task.is_free = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return space.isFree(a, b);
    };
    TreeResult found = growTrees(task, asked.rng.fork("trees/" + std::to_string(searches++)));
    answer.iterations += found.iterations;
    if (asked.trees == TreeDetail::kKeep) answer.trees = std::move(found.trees);
    if (found.line.empty()) return noteReached(found.reached), false;
    accept(found.line, space,
           task.kind == TreeKind::kStar ? "found by RRT*" : "found by RRT-Connect");
    return true;
  }

  static Eigen::Vector3d drawn(const map::FreeVoxels* known, const AxisAlignedBox& region,
                               Rng& rng) {
    if (known != nullptr)
      if (const auto point = known->draw(rng)) return *point;
    const double x = rng.uniform(region.min.x(), region.max.x());
    const double y = rng.uniform(region.min.y(), region.max.y());
    const double z = rng.uniform(region.min.z(), region.max.z());
    return {x, y, z};
  }

  AxisAlignedBox searchRegion(const Attempt& attempt) const {
    const AxisAlignedBox ends = hull({start, start}, {asked.goal.position, asked.goal.position});
    AxisAlignedBox region = hull(asked.map->knownBounds(), ends);
    if (attempt.unknown == Unknown::kOpen) region = hull(region, grown(ends, kRoomAround_m));
    return hull(intersection(region, asked.bounds), ends);
  }

  void noteReached(const std::vector<Eigen::Vector3d>& reached) {
    const Eigen::Vector3d& goal = asked.goal.position;
    for (const Eigen::Vector3d& place : reached) {
      const bool is_nearer =
          !answer.nearest_reachable ||
          (place - goal).squaredNorm() < (*answer.nearest_reachable - goal).squaredNorm();
      if (is_nearer && spaces.known.isFree(place)) answer.nearest_reachable = place;
    }
  }

  void accept(const std::vector<Eigen::Vector3d>& line, const SearchSpace& space,
              const std::string& reason) {
    answer.status = NavigationStatus::kOk;
    answer.reason = reason;
    answer.nearest_reachable.reset();
    if (start != asked.start.position) answer.path.push_back(asked.start);
    for (const Eigen::Vector3d& point : line) answer.path.push_back({point, asked.start.yaw});
    answer.path.front() = asked.start;
    answer.path.back() = asked.goal;
    if (space.clearance() == Clearance::kSafeDistance)
      answer.safe_distance_m = params.safe_distance_m;
    noteKnownLength();
  }

  /// The step out of a start that touches something counts as known: the robot stands in it.
  void noteKnownLength() {
    const bool steps_out = start != asked.start.position;
    const Path rest(answer.path.begin() + (steps_out ? 1 : 0), answer.path.end());
    answer.known_length_m = checkPath(spaces.known, rest, {}, {}).arc_m;
    if (steps_out) answer.known_length_m += (start - asked.start.position).norm();
  }

  double secondsLeft() const { return asked.time_limit_s - 1e-3 * watch.milliseconds(); }

  std::string noPathReason() const {
    const char* where = is_goal_known ? "to the goal" : "to the goal, unknown space included,";
    return std::string("no path ") + where + " within " + std::to_string(answer.iterations) +
           " iterations";
  }

  const NavigationQuery& asked;
  const NavigationParams& params;
  RobotSpaces& spaces;
  Method method;
  Eigen::Vector3d start;
  bool is_goal_known = false;
  int searches = 0;
  Stopwatch watch;
  NavigationAnswer answer;
};

}  // namespace

std::vector<std::string> NavigationParams::problems() const {
  if (methodNamed(method)) return {};
  return {"navigation.method = '" + method + "': write adaptive, rrt_star, plain or plain_short"};
}

const char* toText(NavigationStatus status) {
  switch (status) {
    case NavigationStatus::kOk:
      return "ok";
    case NavigationStatus::kStartBlocked:
      return "start_blocked";
    case NavigationStatus::kGoalBlocked:
      return "goal_blocked";
    case NavigationStatus::kGoalUnknown:
      return "goal_unknown";
    case NavigationStatus::kOutOfBounds:
      return "out_of_bounds";
    case NavigationStatus::kNoGo:
      return "no_go";
    case NavigationStatus::kNoPath:
      return "no_path";
  }
  return "unknown";
}

struct Navigator::Impl {
  RobotSpaces& spacesFor(const Eigen::Vector3d& box,
                         const std::shared_ptr<const map::FrozenMap>& map) {
    if (!spaces || spaces->known.boxSize() != box) spaces.emplace(box, params.safe_distance_m);
    spaces->use(map);
    return *spaces;
  }

  NavigationParams params;
  std::optional<RobotSpaces> spaces;
};

Navigator::Navigator(const NavigationParams& params) : impl_(new Impl{params, std::nullopt}) {
  require(params.problems().empty(), "Navigator: bad parameters");
}
Navigator::~Navigator() = default;
Navigator::Navigator(Navigator&&) noexcept = default;
Navigator& Navigator::operator=(Navigator&&) noexcept = default;

NavigationAnswer Navigator::plan(const NavigationQuery& query) {
  require(query.map != nullptr, "Navigator: no map");
  require(isFinite(query.start) && isFinite(query.goal), "Navigator: start or goal is not finite");
  require(query.box.allFinite() && (query.box.array() > 0.0).all(), "Navigator: bad box");
  const Stopwatch watch;
  NavigationAnswer answer =
      Query(query, impl_->params, impl_->spacesFor(query.box, query.map)).run();
  answer.planning_ms = watch.milliseconds();
  return answer;
}

bool Navigator::keepsSafeDistance(const std::shared_ptr<const map::FrozenMap>& map,
                                  const Eigen::Vector3d& box, const Eigen::Vector3d& place) {
  return impl_->spacesFor(box, map).safe.isFree(place);
}

const NavigationParams& Navigator::params() const { return impl_->params; }

}  // namespace spelunk::navigation
