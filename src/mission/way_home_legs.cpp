#include <cmath>

#include "spelunk/common/message_text.h"
#include "spelunk/mission/way_home.h"
#include "spelunk/navigation/path_shortening.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/navigation/trajectory_timing.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;

/// Short cuts of the trail are tried up to this length: longer ones cost more time than they save.
constexpr double kShortenReach_m = 6.0;
/// Beyond the distance to a standstill, for its timing.
constexpr double kStopSlack_m = 0.1;
/// Slower, the robot turns round where it is.
constexpr double kTurnsAtOnce_mps = 0.1;
/// A way that saves less than a twentieth is not worth another turn.
constexpr double kWorthReplacing = 0.95;
constexpr int kIterations = 4000;          // of one query; several follow each other
constexpr std::size_t kPlacesOnTrail = 3;  // that home is still reachable from
/// So far within the home radius a place counts as home, or the robot would end beside it.
constexpr double kAtHomeSlack_m = 0.2;

std::string placeText(const char* what, const Eigen::Vector3d& place, double metres_away) {
  return "the way home is " + std::string(what) + " at " + placeOf(place) + ", " +
         withNumber("%.1f m from here", metres_away);
}

}  // namespace

/// A way along the trail begins behind the robot: it brakes first, and comes back.
Path WayHome::fromMotion(const KnownWay& way, double now_s) const {
  const auto& active = basis_.flight.active();
  if (!active || way.follows_active) return way.path;
  const double arc = active->arcAt(now_s);
  const double speed = active->reference(now_s).velocity.norm();
  const double braking = 0.5 * speed * speed / basis_.robot.acceleration_max_mps2 + kStopSlack_m;
  const Path ahead = active->line(arc, arc + (speed > kTurnsAtOnce_mps ? braking : 0.0));
  return joined(joined(ahead, reversed(ahead)), way.path);
}

std::optional<Leg> WayHome::findLeg(double now_s) {
  SafeSpace& space = basis_.space;
  const Eigen::Vector3d& box = basis_.robot.box_m;
  auto by_trail = wayByTrail();
  if (by_trail) {
    if (kindOf(basis_.robot) == RobotKind::kAerial)
      by_trail->path = navigation::shortened(by_trail->path, space.of(box), kShortenReach_m);
    by_trail->path = fromMotion(*by_trail, now_s);
    by_trail->travel_s = travelTime(by_trail->path);
  }
  const auto by_route = wayByRoute(now_s);
  if (by_route && space.isClear(by_route->path, box) &&
      (!by_trail || by_route->travel_s < by_trail->travel_s ||
       !space.isTrailClear(by_trail->path, tightBox())) &&
      isWorthTheRisk(by_route->travel_s, by_trail))
    return Leg(by_route->path, PathKind::kHome, box);
  for (const Eigen::Vector3d& each : {box, tightBox()})
    if (by_trail && space.isTrailClear(by_trail->path, each))
      return Leg(by_trail->path, PathKind::kHome, each);
  obstacle_ = whatBlocks();
  return std::nullopt;
}

bool WayHome::isWorthTheRisk(double travel_s, const std::optional<KnownWay>& known) {
  if (!known || !basis_.space.isTrailClear(known->path, tightBox())) return true;
  const EnduranceGuard& guard = basis_.endurance.guard();
  const double left_s = guard.remaining();
  return guard.pessimistic(known->travel_s) > left_s ||
         guard.pessimistic(known->travel_s + 2.0 * travel_s) <= left_s;
}

std::optional<Leg> WayHome::legOfSeenWay(const Path& whole, double now_s) {
  const double travel_s = travelTime(whole);
  const auto& active = basis_.flight.active();
  if (active && travel_s > kWorthReplacing * (active->endTime() - now_s)) return std::nullopt;
  const auto by_trail = wayByTrail();
  if (!isWorthTheRisk(travel_s, by_trail)) return std::nullopt;
  if (!by_trail && basis_.space.isClear(whole, basis_.robot.box_m)) graph_->addRoute(whole);
  return Leg(whole, PathKind::kHome, basis_.robot.box_m);
}

/// With the full box home comes first; with the tight one the nearest places on the trail, so that
/// little is flown without margin.
WayHomeSearch WayHome::search(const Pose& from, const std::shared_ptr<const map::FrozenMap>& map,
                              const Rng& rng, const std::string& stream) {
  WayHomeSearch search;
  search.params.iterations = kIterations;
  const auto add = [&](const std::optional<Pose>& goal, const Eigen::Vector3d& box) {
    if (!goal) return;
    navigation::NavigationQuery query;
    query.map = map;
    query.start = from;
    query.goal = *goal;
    query.box = box;
    query.zones = basis_.space.zones().all();
    query.region = navigation::SearchRegion::kKnown;
    query.rng = rng.fork(stream + "/" + std::to_string(search.queries.size()));
    search.queries.push_back(std::move(query));
  };
  const std::vector<Pose> trail_places = placesOnTrail();
  const Eigen::Vector3d& box = basis_.robot.box_m;
  add(findPlaceAtHome(box), box);
  for (const Pose& place : trail_places) add(place, box);
  for (const Pose& place : trail_places) add(place, tightBox());
  add(findPlaceAtHome(tightBox()), tightBox());
  return search;
}

/// Home, or where it is blocked the first place of the trail that still counts as home.
std::optional<Pose> WayHome::findPlaceAtHome(const Eigen::Vector3d& box) {
  for (const Pose& pose : trail()) {
    const double gap = distance(pose, home());
    if (gap > 0.0 && gap > basis_.params.home_radius_m - kAtHomeSlack_m) continue;
    if (basis_.space.isTrailClear({pose}, box)) return pose;
  }
  return std::nullopt;
}

/// The nearest places that home is still reachable from.
std::vector<Pose> WayHome::placesOnTrail() {
  std::vector<Pose> places;
  for (const Pose& place : graph_->placesBeforeHome(basis_.watch.pose())) {
    const auto onward = graph_->wayFrom(place);
    if (!onward || !basis_.space.isTrailClear(*onward, tightBox())) continue;
    places.push_back(place);
    if (places.size() == kPlacesOnTrail) break;
  }
  return places;
}

std::optional<Leg> WayHome::legOfFoundWay(const planners::PlanResult& found) {
  if (found.status != planners::PlanStatus::kOk) return std::nullopt;
  Path way = found.path;
  if (distance(way.back(), home()) > basis_.params.home_radius_m) {
    const auto onward = graph_->wayFrom(way.back());
    if (!onward) return std::nullopt;
    way.insert(way.end(), onward->begin() + 1, onward->end());
  }
  for (const Eigen::Vector3d& box : {basis_.robot.box_m, tightBox()}) {
    if (!basis_.space.checkLeavingForHome(way, box).isFree()) continue;
    if (basis_.space.isTrailClear(found.path, basis_.robot.box_m)) graph_->addRoute(found.path);
    return Leg(way, PathKind::kHome, box);
  }
  return std::nullopt;
}

/// One sentence on what lies between the robot and home.
std::string WayHome::whatBlocks() {
  const Pose& here = basis_.watch.pose();
  const auto way = graph_->wayFrom(here);
  if (!way) {
    const auto cut = graph_->findCut(here);
    if (!cut) return "no way home is known from here";
    return placeText("cut", *cut, (*cut - here.position).norm());
  }
  const auto check = basis_.space.checkTrail(*way, tightBox());
  const Eigen::Vector3d place = poseAt(*way, check.arc_m).position;
  const std::string what = std::string("blocked (") + navigation::toText(check.fault) +
                           (check.zone.empty() ? "" : " '" + check.zone + "'") + ")";
  return placeText(what.c_str(), place, (place - here.position).norm());
}

}  // namespace spelunk::mission
