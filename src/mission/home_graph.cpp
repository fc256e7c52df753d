#include "spelunk/mission/home_graph.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace spelunk::mission {
namespace {

constexpr double kTrailSpacing_m = 0.5;       // half a body: the line between two places was flown
constexpr double kRouteSpacing_m = 1.0;       // a blocked edge costs no more of a checked way
constexpr double kShortcutReach_m = 2.5;      // across a drift, or a pillar
constexpr double kShortcutWorth = 2.0;        // a shortcut saves at least half of the way between
constexpr std::size_t kShortcutTries = 4;     // from one place; each is a sweep
constexpr double kTightCost = 20.0;           // flown once, but the margin is gone: the last resort
constexpr double kJoinReach_m = 2.0;          // of a robot that has just left the trail
constexpr double kJoinReachOnFoot_m = 0.75;   // where it has walked, and no straight way elsewhere
constexpr double kJoinCost = 1.5;             // the way to the trail is not checked
constexpr std::size_t kRechecksPerCall = 20;  // so that a call stays within a millisecond
constexpr double kPlaceSpacing_m = 2.0;       // nearer places lie behind the same obstacle

}  // namespace

HomeGraph::HomeGraph(const Pose& home, const Eigen::Vector3d& box, double resolution_m,
                     Footing footing)
    : box_(box),
      footing_(std::move(footing)),
      space_(box),
      tight_space_(tightBox(box)),
      swept_(box, resolution_m),
      swept_tight_(tightBox(box), resolution_m) {
  trail_.push_back(home);
  last_trail_vertex_ = graph_.addVertex(home.position);
}

void HomeGraph::addEdge(graph::VertexId a, graph::VertexId b, Origin origin) {
  if (a == b || graph_.hasEdge(a, b)) return;
  if (origin == Origin::kChecked && isForbidden(graph_.position(a), graph_.position(b))) return;
  const auto id = static_cast<std::uint32_t>(edges_.size());
  edges_.push_back({a, b, origin == Origin::kFlown, false, EdgeState::kOpen});
  const Eigen::Vector3d& from = graph_.position(a);
  const Eigen::Vector3d& to = graph_.position(b);
  graph_.addEdge(a, b, (to - from).norm());
  swept_.add(from, to, id);
  swept_tight_.add(from, to, id);
  if (from_home_) from_home_->takeEdge(graph_, a, b);
}

void HomeGraph::addTrail(const Pose& pose) {
  if (distance(pose, trail_.back()) < kTrailSpacing_m) return;
  trail_.push_back(pose);
  const graph::VertexId id = graph_.addVertex(pose.position);
  addEdge(last_trail_vertex_, id, Origin::kFlown);
  last_trail_vertex_ = id;
}

void HomeGraph::addRoute(const Path& route) {
  if (route.empty()) return;
  auto last = graph_.findNearest(route.front().position);
  for (const Pose& pose : resampled(route, kRouteSpacing_m)) {
    const auto near = graph_.findNearest(pose.position);
    const bool joins = near && (graph_.position(*near) - pose.position).norm() < 0.1;
    const graph::VertexId id = joins ? *near : graph_.addVertex(pose.position);
    if (last) addEdge(*last, id, Origin::kChecked);
    last = id;
  }
}

void HomeGraph::setState(Edge& edge, EdgeState state) {
  if (edge.state == state) return;
  edge.state = state;
  from_home_.reset();
  const double length = (graph_.position(edge.a) - graph_.position(edge.b)).norm();
  if (state == EdgeState::kCut) {
    graph_.removeEdge(edge.a, edge.b);
  } else {
    graph_.addEdge(edge.a, edge.b, state == EdgeState::kTight ? kTightCost * length : length);
  }
}

bool HomeGraph::isForbidden(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  return std::any_of(zones_.begin(), zones_.end(),
                     [&](const NoGoZone& zone) { return sweptBoxMeets(zone, a, b, box_); });
}

void HomeGraph::noteZone(const NoGoZone& zone) {
  zones_.push_back(zone);
  for (Edge& edge : edges_) {
    if (edge.is_flown ||
        !sweptBoxMeets(zone, graph_.position(edge.a), graph_.position(edge.b), box_))
      continue;
    edge.is_forbidden = true;
    setState(edge, EdgeState::kCut);
  }
}

bool HomeGraph::noteOccupied(const std::vector<map::VoxelIndex>& voxels) {
  bool has_changed = false;
  for (const auto& hit : swept_.touching(voxels)) {
    Edge& edge = edges_[hit.id];
    if (edge.state != EdgeState::kOpen) continue;
    setState(edge, edge.is_flown ? EdgeState::kTight : EdgeState::kCut);
    cut_.push_back(hit.id);
    has_changed = true;
  }
  for (const auto& hit : swept_tight_.touching(voxels)) {
    has_changed = has_changed || edges_[hit.id].state != EdgeState::kCut;
    setState(edges_[hit.id], EdgeState::kCut);
  }
  return has_changed;
}

void HomeGraph::use(const std::shared_ptr<const map::FrozenMap>& map) {
  space_.use(map);
  tight_space_.use(map);
}

bool HomeGraph::isFree(graph::VertexId a, graph::VertexId b, map::ConfigurationSpace& space) const {
  return space.isSweepFree(graph_.position(a), graph_.position(b));
}

void HomeGraph::recheck(Edge& edge) {
  if (edge.is_forbidden) return;
  if (isFree(edge.a, edge.b, space_)) {
    setState(edge, EdgeState::kOpen);
  } else if (edge.is_flown && isFree(edge.a, edge.b, tight_space_)) {
    setState(edge, EdgeState::kTight);
  }
}

void HomeGraph::connect(const std::shared_ptr<const map::FrozenMap>& map) {
  use(map);
  const std::size_t count = graph_.vertexCount();
  for (; next_to_connect_ < count; ++next_to_connect_)
    tryShortcuts(static_cast<graph::VertexId>(next_to_connect_), *map);
  const std::size_t some = std::min(cut_.size(), kRechecksPerCall);
  const std::vector<std::uint32_t> first(cut_.begin(), cut_.begin() + static_cast<long>(some));
  cut_.erase(cut_.begin(), cut_.begin() + static_cast<long>(some));
  for (const std::uint32_t id : first) {
    recheck(edges_[id]);
    if (edges_[id].state != EdgeState::kOpen) cut_.push_back(id);
  }
}

void HomeGraph::recheckAll(const std::shared_ptr<const map::FrozenMap>& map) {
  use(map);
  for (Edge& edge : edges_)
    if (edge.state != EdgeState::kOpen) recheck(edge);
}

void HomeGraph::tryShortcuts(graph::VertexId id, const map::FrozenMap& map) {
  std::size_t tries = 0;
  for (const graph::VertexId other : graph_.findWithin(graph_.position(id), kShortcutReach_m)) {
    if (other >= id || graph_.hasEdge(id, other)) continue;
    const double gap = (graph_.position(id) - graph_.position(other)).norm();
    const double between =
        static_cast<double>(graph::indexOf(id) - graph::indexOf(other)) * kTrailSpacing_m;
    if (between < kShortcutWorth * std::max(gap, kTrailSpacing_m)) continue;
    if (++tries > kShortcutTries) return;
    if (!isFree(id, other, space_)) continue;
    if (footing_ && !footing_(map, graph_.position(id), graph_.position(other))) continue;
    addEdge(id, other, Origin::kChecked);
  }
}

const graph::ShortestPaths& HomeGraph::fromHome() {
  if (!from_home_) from_home_ = graph::shortestPaths(graph_, graph::VertexId{0});
  from_home_->takeVertices(graph_);
  return *from_home_;
}

std::optional<Path> HomeGraph::wayFrom(const Pose& from) {
  const graph::ShortestPaths& paths = fromHome();
  std::optional<graph::VertexId> best;
  double least = std::numeric_limits<double>::infinity();
  std::vector<graph::VertexId> near =
      graph_.findWithin(from.position, footing_ ? kJoinReachOnFoot_m : kJoinReach_m);
  if (near.empty()) near.push_back(*graph_.findNearest(from.position));
  for (const graph::VertexId id : near) {
    if (!paths.reaches(id)) continue;
    const double cost =
        kJoinCost * (graph_.position(id) - from.position).norm() + paths.distanceTo(id);
    if (cost >= least) continue;
    least = cost;
    best = id;
  }
  if (!best) return std::nullopt;
  std::vector<graph::VertexId> ids = paths.pathTo(*best);
  Path way{from};
  for (auto id = ids.rbegin(); id != ids.rend(); ++id)
    way.push_back({graph_.position(*id), from.yaw});
  way.back().yaw = home().yaw;
  return way;
}

std::vector<Pose> HomeGraph::placesBeforeHome(const Pose& from) {
  const graph::ShortestPaths& paths = fromHome();
  std::vector<Pose> places;
  for (const graph::VertexId id :
       graph_.findWithin(from.position, std::numeric_limits<double>::infinity())) {
    if (!paths.reaches(id)) continue;
    const Pose place{graph_.position(id), from.yaw};
    const bool is_apart = std::all_of(places.begin(), places.end(), [&](const Pose& other) {
      return distance(place, other) >= kPlaceSpacing_m;
    });
    if (is_apart) places.push_back(place);
  }
  return places;
}

std::optional<Eigen::Vector3d> HomeGraph::findCut(const Pose& from) {
  const graph::ShortestPaths& paths = fromHome();
  std::optional<Eigen::Vector3d> nearest;
  std::optional<graph::VertexId> begin;  // of a run of edges that are cut, one after the other
  for (const Edge& edge : edges_) {
    if (!edge.is_flown) continue;
    if (edge.state == EdgeState::kCut) {
      if (!begin) begin = edge.a;
      continue;
    }
    if (begin && paths.reaches(*begin) != paths.reaches(edge.a)) {
      const Eigen::Vector3d middle = 0.5 * (graph_.position(*begin) + graph_.position(edge.a));
      if (!nearest || (middle - from.position).norm() < (*nearest - from.position).norm())
        nearest = middle;
    }
    begin.reset();
  }
  return nearest;
}

}  // namespace spelunk::mission
