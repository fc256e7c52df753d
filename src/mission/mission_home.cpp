#include <algorithm>
#include <cmath>

#include "mission_impl.h"
#include "spelunk/navigation/path_shortening.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr double kWorthMerging = 0.8;  // of the way along the trail
constexpr double kMergeFrom_s = 20.0;
constexpr double kMergePeriod_s = 10.0;
constexpr double kWorthReplacing = 0.95;
constexpr double kRouteGap_m = 1.0;
constexpr double kShortenReach_m = 6.0;
constexpr double kHomeRetry_s = 1.0;
constexpr double kStopSlack_m = 0.1;

void append(Path& path, const Path& more) {
  for (const Pose& pose : more)
    if (path.empty() || distance(path.back(), pose) > 1e-6) path.push_back(pose);
}

}  // namespace

void Mission::Impl::noteRoute(const Path& rest, const planners::PlanResult& home) {
  route.reset();
  if (home.status != planners::PlanStatus::kOk) return;
  Path path = rest;
  append(path, home.path);
  if (!isWayClear(path, robot.box_m)) return;
  const double travel = navigation::travelTime(path, limitsOf(robot));
  navigation::PathMonitor monitor(path, robot.box_m, map.params().resolution_m);
  route.emplace(KnownRoute{std::move(path), travel, std::move(monitor)});
}

std::optional<WayHome> Mission::Impl::wayByTrail() {
  auto path = home_graph->wayFrom(input.latest()->pose);
  if (!path) {
    home_graph->recheckAll(map.freeze());
    path = home_graph->wayFrom(input.latest()->pose);
  }
  if (!path) return std::nullopt;
  const double travel = navigation::travelTime(*path, limitsOf(robot));
  return WayHome{std::move(*path), travel, false};
}

std::optional<WayHome> Mission::Impl::wayByRoute() const {
  if (!route) return std::nullopt;
  Path path;
  if (active) {
    if (active->blockedAt()) return std::nullopt;
    path = active->line(active->arcAt(now), active->length());
  } else {
    const Pose& pose = input.latest()->pose;
    if (distance(pose, route->path.front()) > kRouteGap_m) return std::nullopt;
    path.push_back(pose);
  }
  const double rest_s = active ? std::max(0.0, active->endTime() - now) : 0.0;
  append(path, route->path);
  return WayHome{std::move(path), rest_s + route->travel_s, true};
}

void Mission::Impl::refreshWayHome() {
  if (!input.latest()) return;
  if (goal == Goal::kHome && active) {  // committed: the way home is what is being flown
    way_home = active->line(active->arcAt(now), active->length());
    way_home_s = std::max(0.0, active->endTime() - now);
  } else {
    const auto by_trail = wayByTrail();
    const auto by_route = wayByRoute();
    const bool route_wins = by_route && (!by_trail || by_route->travel_s < by_trail->travel_s);
    if (!by_route && !by_trail) {
      if (goal == Goal::kExplore) goHome("no known way home is clear any more", HomeCause::kOther);
      return;
    }
    const WayHome& best = route_wins ? *by_route : *by_trail;
    way_home = best.path;
    way_home_s = best.travel_s;
    const bool merges = route_wins && by_trail && by_trail->travel_s > kMergeFrom_s &&
                        by_route->travel_s < kWorthMerging * by_trail->travel_s &&
                        now >= next_merge_s;
    if (merges) {
      home_graph->addRoute(by_route->path);
      next_merge_s = now + kMergePeriod_s;
    }
  }
  status.way_home_s = guard.pessimistic(way_home_s);
  status.margin_s = guard.margin(way_home_s);
}

bool Mission::Impl::isAtHome() const {
  return distance(input.latest()->pose, home_graph->home()) <= params.home_radius_m;
}

map::ConfigurationSpace& Mission::Impl::spaceOf(const Eigen::Vector3d& box,
                                                map::Passable passable) {
  auto found = std::find_if(spaces.begin(), spaces.end(), [&](const map::ConfigurationSpace& each) {
    return each.boxSize() == box && each.passable() == passable;
  });
  if (found == spaces.end()) found = spaces.emplace(spaces.end(), box, passable);
  found->use(map.freeze());
  return *found;
}

bool Mission::Impl::isWayClear(const Path& path, const Eigen::Vector3d& box) {
  return navigation::checkPath(spaceOf(box), path, no_go, {}).isFree();
}

bool Mission::Impl::isTrailClear(const Path& path, const Eigen::Vector3d& box) {
  return navigation::checkPath(spaceOf(box), path, given_zones, {}).isFree();
}

void Mission::Impl::goHome(const std::string& why, HomeCause cause) {
  may_look_again = cause == HomeCause::kEndurance && goal == Goal::kExplore;
  goal = Goal::kHome;
  pending.reset();
  running.reset();
  wants_way_home = true;
  next_ask_s = now;
  status.end_reason = why;
  enter(MissionState::kHome, why);
  if (inputs_ok) launchHome();
}

void Mission::Impl::stepHome() {
  if (goal != Goal::kHome || active || !inputs_ok) return;
  if (isAtHome()) {
    goal = Goal::kNone;
    command = Command{};
    return enter(MissionState::kDone, status.end_reason);
  }
  const bool may_try =
      isAtRest() && now >= hold_since_s + (state == MissionState::kHold ? kHomeRetry_s : 0.0);
  if (may_try) launchHome();
}

Path Mission::Impl::fromMotion(const WayHome& way) const {
  if (!active || way.follows_active) return way.path;
  const double arc = active->arcAt(now);
  const double speed = active->reference(now).velocity.norm();
  const double braking = 0.5 * speed * speed / robot.acceleration_max_mps2 + kStopSlack_m;
  Path path = active->line(arc, arc + (speed > 0.1 ? braking : 0.0));
  const Path back = reversed(path);
  append(path, back);
  append(path, way.path);
  return path;
}

void Mission::Impl::launchHome() {
  if (!active && isAtHome()) return;
  auto by_trail = wayByTrail();
  if (by_trail && !terrain) {
    by_trail->path = navigation::shortened(by_trail->path, spaceOf(robot.box_m), kShortenReach_m);
    by_trail->travel_s = navigation::travelTime(by_trail->path, limitsOf(robot));
  }
  const auto by_route = wayByRoute();
  const Eigen::Vector3d tight = HomeGraph::tightBox(robot.box_m);
  if (by_route && isWayClear(by_route->path, robot.box_m) &&
      (!by_trail || by_route->travel_s < by_trail->travel_s ||
       !isTrailClear(by_trail->path, tight)) &&
      isWorthTheRisk(by_route->travel_s, by_trail))
    return fly(by_route->path, planners::PathKind::kHome, robot.box_m);
  if (by_trail && isTrailClear(by_trail->path, robot.box_m))
    return fly(fromMotion(*by_trail), planners::PathKind::kHome, robot.box_m);
  if (by_trail && isTrailClear(by_trail->path, tight))
    return fly(fromMotion(*by_trail), planners::PathKind::kHome, tight);
  wants_way_home = true;
  home_obstacle = whatBlocksWayHome();
  const std::string why = home_obstacle + ": holding and looking for another";
  if (state != MissionState::kHold || !running) return hold(why, planners::PathOutcome::kBlocked);
  hold_since_s = now;  // an answer is under way: a new stop would throw it away
}

/// Planner and navigation are asked in turn until one of them knows a way, or the trail is free.
void Mission::Impl::onNoWayHome(const RunningJob& job, const planners::PlanResult& home) {
  next_ask_s = now + kHomeRetry_s;
  wants_way_home = !active;
  if (active) return;
  asks_navigation = !terrain && !job.by_navigation;  // navigation knows nothing of footing
  say(LogLevel::kWarn, "home",
      home_obstacle +
          (job.by_navigation ? "; no way round it is known: " : "; the planner knows no other: ") +
          home.reason);
}

bool Mission::Impl::isWorthTheRisk(double travel_s, const std::optional<WayHome>& known) {
  if (!known || !isTrailClear(known->path, HomeGraph::tightBox(robot.box_m))) return true;
  const double left_s = guard.remaining();
  return known->travel_s > left_s || known->travel_s + 2.0 * travel_s <= left_s;
}

void Mission::Impl::acceptWayHome(const RunningJob& job, const planners::PlanResult& home) {
  wants_way_home = false;
  const bool late = active ? now > job.takes_over_s + 1e-6
                           : distance(input.latest()->pose, job.pose) > kRouteGap_m;
  if (job.by_navigation && !active && !late && flyWayFound(home)) return;
  const bool usable = !job.by_navigation && home.status == planners::PlanStatus::kOk && !late &&
                      isWayClear(home.path, robot.box_m);
  if (!usable) return onNoWayHome(job, home);
  const Path whole = joined(job, home.path);
  const double travel = navigation::travelTime(whole, limitsOf(robot));
  if (active && travel > kWorthReplacing * (active->endTime() - now)) return;
  if (!isWorthTheRisk(travel, wayByTrail())) return;
  fly(whole, planners::PathKind::kHome, robot.box_m);
}

}  // namespace spelunk::mission
