#include "spelunk/mission/way_home.h"

#include <algorithm>
#include <utility>

#include "spelunk/navigation/trajectory_timing.h"

namespace spelunk::mission {
namespace {

/// Of the trail that planners are told: they need no more than one place a metre.
constexpr double kStampedSpacing_m = 1.0;
/// A planner's way joins the graph where it saves a fifth of the way along the trail, which is
/// long, and not at every refresh: each one adds edges for good.
constexpr double kWorthMerging = 0.8;
constexpr double kMergeFrom_s = 20.0;
constexpr double kMergePeriod_s = 10.0;
/// A route begins at the very end of the path that it was noted for; a path that took over from
/// that one ends elsewhere. Its end may be a little higher or lower, for headroom.
constexpr double kSameEnd_m = 0.5;
/// Steps in which a path is shortened until it can be afforded.
constexpr double kCutStep_m = 1.0;

}  // namespace

void WayHome::begin() {
  const RobotState& state = basis_.watch.state();
  graph_.emplace(state.pose, basis_.robot.box_m, basis_.space.resolution(), basis_.space.footing());
  stamped_.push_back({state.stamp_s, state.pose});
}

void WayHome::takeUp(const Path& trail, const std::vector<NoGoZone>& marked_zones) {
  if (trail.empty()) return;
  graph_.emplace(trail.front(), basis_.robot.box_m, basis_.space.resolution(),
                 basis_.space.footing());
  for (const Pose& pose : trail) graph_->addTrail(pose);
  for (const NoGoZone& zone : marked_zones) graph_->noteZone(zone);
}

bool WayHome::isAtHome() const {
  return distance(basis_.watch.pose(), home()) <= basis_.params.home_radius_m;
}

bool WayHome::noteOdometry() {
  const RobotState& state = basis_.watch.state();
  const std::size_t before = trail().size();
  graph_->addTrail(state.pose);
  if (stamped_.empty() || distance(stamped_.back().pose, state.pose) >= kStampedSpacing_m)
    stamped_.push_back({state.stamp_s, state.pose});
  return trail().size() != before;
}

void WayHome::noteOccupied(const std::vector<map::VoxelIndex>& voxels, double now_s) {
  if (graph_ && graph_->noteOccupied(voxels)) next_refresh_s_ = now_s;
  if (!route_ || !route_->monitor.firstHit(voxels)) return;
  route_.reset();
  next_refresh_s_ = now_s;
}

void WayHome::noteRoute(const Path& rest, const planners::PlanResult& home) {
  route_.reset();
  if (home.status != planners::PlanStatus::kOk) return;
  Path path = joined(rest, home.path);
  if (!basis_.space.isClear(path, basis_.robot.box_m)) return;
  const double travel_s = travelTime(path);
  navigation::PathMonitor monitor(path, basis_.robot.box_m, basis_.space.resolution());
  route_.emplace(Route{std::move(path), travel_s, std::move(monitor)});
}

double WayHome::travelTime(const Path& path) const {
  return navigation::travelTime(path, basis_.flight.limits(), basis_.space.narrowPieces(path));
}

std::optional<KnownWay> WayHome::wayByTrail() {
  auto path = graph_->wayFrom(basis_.watch.pose());
  if (!path) {
    graph_->recheckAll(basis_.space.map().freeze());
    path = graph_->wayFrom(basis_.watch.pose());
  }
  if (!path) return std::nullopt;
  const double travel_s = travelTime(*path);
  return KnownWay{std::move(*path), travel_s, false};
}

std::optional<KnownWay> WayHome::wayByRoute(double now_s) const {
  if (!route_) return std::nullopt;
  Path path;
  if (const auto& active = basis_.flight.active()) {
    if (active->blockedAt()) return std::nullopt;
    path = basis_.flight.rest(now_s);
    if (distance(path.back(), route_->path.front()) > kSameEnd_m) return std::nullopt;
  } else {
    const Pose& here = basis_.watch.pose();
    if (distance(here, route_->path.front()) > kBeginsHere_m) return std::nullopt;
    path.push_back(here);
  }
  return KnownWay{joined(std::move(path), route_->path),
                  basis_.flight.restTime(now_s) + route_->travel_s, true};
}

void WayHome::followActive(double now_s) {
  is_clear_ = true;
  way_ = basis_.flight.rest(now_s);
  way_s_ = basis_.flight.restTime(now_s);
}

bool WayHome::refresh(double now_s) {
  const auto by_trail = wayByTrail();
  const auto by_route = wayByRoute(now_s);
  is_clear_ = by_route || by_trail;
  if (!is_clear_) return false;
  const bool route_wins = by_route && (!by_trail || by_route->travel_s < by_trail->travel_s);
  const KnownWay& best = route_wins ? *by_route : *by_trail;
  way_ = best.path;
  way_s_ = best.travel_s;
  if (route_wins && by_trail) mergeIfWorth(*by_route, *by_trail, now_s);
  return true;
}

void WayHome::mergeIfWorth(const KnownWay& by_route, const KnownWay& by_trail, double now_s) {
  const bool is_worth =
      by_trail.travel_s > kMergeFrom_s && by_route.travel_s < kWorthMerging * by_trail.travel_s;
  if (!is_worth || now_s < next_merge_s_) return;
  graph_->addRoute(by_route.path);
  next_merge_s_ = now_s + kMergePeriod_s;
}

double WayHome::affordableLength(const Path& path, const std::optional<Path>& home_path) const {
  const EnduranceGuard& guard = basis_.endurance.guard();
  const double length = lengthOf(path);
  const double home_from_end_s = home_path ? travelTime(*home_path) : guard.remaining();
  const auto slow = basis_.space.narrowPieces(path);
  for (double end = length; end > 0.0; end -= kCutStep_m) {
    const double there_s =
        navigation::travelTime(slice(path, 0.0, end), basis_.flight.limits(), slow);
    const double onward_s = home_from_end_s + (length - end) / basis_.robot.speed_max_mps;
    const double home_s = std::min(there_s + way_s_, onward_s);
    if (guard.marginAfter(there_s, home_s) >= 0.0) return end;
  }
  return 0.0;
}

}  // namespace spelunk::mission
