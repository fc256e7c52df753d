#include <cmath>
#include <cstdio>

#include "mission_impl.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::mission {
namespace {

constexpr int kIterations = 4000;          // of one query; several follow each other
constexpr std::size_t kPlacesOnTrail = 3;  // that home is still reachable from
constexpr double kAtHomeSlack_m = 0.2;

std::string placeText(const char* what, const Eigen::Vector3d& place, double metres_away) {
  char distance[32];
  std::snprintf(distance, sizeof distance, "%.1f m from here", metres_away);
  return "the way home is " + std::string(what) + " at " + placeOf(place) + ", " + distance;
}

}  // namespace

std::string placeOf(const Eigen::Vector3d& point) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.1f, %.1f, %.1f)", point.x(), point.y(), point.z());
  return text;
}

/// Full box before the tight one that flown edges are allowed. With the full box home comes first;
/// with the tight one the nearest places on the trail, so that little is flown without margin.
WayHomeSearch Mission::Impl::searchForWayHome(const RunningJob& job) {
  WayHomeSearch search;
  search.params.iterations = kIterations;
  const std::vector<Pose> trail_places = placesOnTrail();
  const Eigen::Vector3d tight = HomeGraph::tightBox(robot.box_m);
  addQuery(search, job, placeAtHome(robot.box_m), robot.box_m);
  for (const Pose& place : trail_places) addQuery(search, job, place, robot.box_m);
  for (const Pose& place : trail_places) addQuery(search, job, place, tight);
  addQuery(search, job, placeAtHome(tight), tight);
  return search;
}

void Mission::Impl::addQuery(WayHomeSearch& search, const RunningJob& job,
                             const std::optional<Pose>& goal_pose,
                             const Eigen::Vector3d& box) const {
  if (!goal_pose) return;
  navigation::NavigationQuery query;
  query.map = frozen;
  query.start = job.pose;
  query.goal = *goal_pose;
  query.box = box;
  query.zones = no_go;
  query.region = navigation::SearchRegion::kKnown;
  query.rng = rng.fork("way_home/" + std::to_string(job.number) + "/" +
                       std::to_string(search.queries.size()));
  search.queries.push_back(std::move(query));
}

/// Home, or where it is blocked the first place of the trail that still counts as home.
std::optional<Pose> Mission::Impl::placeAtHome(const Eigen::Vector3d& box) {
  const Pose& home = home_graph->home();
  for (const Pose& pose : home_graph->trail()) {
    const double gap = distance(pose, home);
    if (gap > 0.0 && gap > params.home_radius_m - kAtHomeSlack_m) continue;
    if (isTrailClear({pose}, box)) return pose;
  }
  return std::nullopt;
}

/// The nearest places that home is still reachable from.
std::vector<Pose> Mission::Impl::placesOnTrail() {
  const Eigen::Vector3d tight = HomeGraph::tightBox(robot.box_m);
  std::vector<Pose> places;
  for (const Pose& place : home_graph->placesBeforeHome(input.latest()->pose)) {
    const auto onward = home_graph->wayFrom(place);
    if (!onward || !isTrailClear(*onward, tight)) continue;
    places.push_back(place);
    if (places.size() == kPlacesOnTrail) break;
  }
  return places;
}

/// A way that the search found, and from its end on the trail; false if it cannot be flown now.
bool Mission::Impl::flyWayFound(const planners::PlanResult& found) {
  if (found.status != planners::PlanStatus::kOk) return false;
  Path way = found.path;
  if (distance(way.back(), home_graph->home()) > params.home_radius_m) {
    const auto onward = home_graph->wayFrom(way.back());
    if (!onward) return false;
    way.insert(way.end(), onward->begin() + 1, onward->end());
  }
  for (const Eigen::Vector3d& box : {robot.box_m, HomeGraph::tightBox(robot.box_m)}) {
    if (!checkLeaving(way, box, given_zones, {}).isFree()) continue;
    if (isTrailClear(found.path, robot.box_m)) home_graph->addRoute(found.path);
    fly(way, planners::PathKind::kHome, box);
    status.reason = found.reason;
    return true;
  }
  return false;
}

/// One sentence on what lies between the robot and home.
std::string Mission::Impl::whatBlocksWayHome() {
  const Pose& here = input.latest()->pose;
  const auto way = home_graph->wayFrom(here);
  if (!way) {
    const auto cut = home_graph->findCut(here);
    if (!cut) return "no way home is known from here";
    return placeText("cut", *cut, (*cut - here.position).norm());
  }
  const auto check =
      navigation::checkPath(spaceOf(HomeGraph::tightBox(robot.box_m)), *way, given_zones, {});
  const Eigen::Vector3d place = poseAt(*way, check.arc_m).position;
  const std::string what = std::string("blocked (") + navigation::toText(check.fault) +
                           (check.zone.empty() ? "" : " '" + check.zone + "'") + ")";
  return placeText(what.c_str(), place, (place - here.position).norm());
}

}  // namespace spelunk::mission
