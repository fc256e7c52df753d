#include "spelunk/planners/shared/trail_home.h"

#include <algorithm>
#include <cmath>

#include "spelunk/graph/shortest_paths.h"

namespace spelunk::planners {
namespace {

using graph::VertexId;

constexpr double kLinkReach_m = 6.0;
constexpr std::size_t kLinksTried = 30;

}  // namespace

void TrailHome::follow(const PlanRequest& request, const Eigen::Vector3d& root,
                       const FreeSpace& space) {
  if (graph_.isEmpty()) graph_.setHome(request.home.position);
  for (const StampedPose& stamped : request.trail) {
    if (stamped.time_s <= known_until_s_) continue;
    graph_.addFlown(stamped.pose.position, space);
    known_until_s_ = stamped.time_s;
  }
  graph_.forgetChecksNear(root, std::numeric_limits<double>::infinity());
  root_ = root;
  linkUp(space);
  if (std::isfinite(metres())) return;
  graph_.reconnect(space);
  linkUp(space);
}

void TrailHome::linkUp(const FreeSpace& space) {
  measure();
  links_.clear();
  std::vector<VertexId> near = graph_.graph().findWithin(root_, kLinkReach_m);
  if (near.size() > kLinksTried) near.resize(kLinksTried);
  for (const VertexId vertex : near) {
    const Eigen::Vector3d& place = graph_.graph().position(vertex);
    if (space.isFree(root_, place)) links_.push_back({vertex, (root_ - place).norm()});
  }
}

void TrailHome::measure() {
  const graph::ShortestPaths shortest = graph::shortestPaths(graph_.graph(), GlobalGraph::home());
  home_m_.clear();
  for (std::size_t i = 0; i < graph_.graph().vertexCount(); ++i)
    home_m_.push_back(shortest.distanceTo(VertexId{static_cast<std::uint32_t>(i)}));
}

void TrailHome::expect(const graph::Polyline& path, const FreeSpace& space) {
  graph_.addPath(path, space);
}

double TrailHome::metresBy(const Link& link) const {
  return link.length_m + home_m_[indexOf(link.vertex)];
}

double TrailHome::metres() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Link& link : links_) least = std::min(least, metresBy(link));
  return least;
}

graph::Polyline TrailHome::findWay(const FreeSpace& space) {
  graph::Polyline way = findKnownWay(space);
  if (!way.empty()) return way;
  graph_.reconnect(space);
  measure();
  return findKnownWay(space);
}

graph::Polyline TrailHome::findKnownWay(const FreeSpace& space) {
  std::vector<Link> links = links_;
  std::stable_sort(links.begin(), links.end(),
                   [&](const Link& a, const Link& b) { return metresBy(a) < metresBy(b); });
  for (const Link& link : links) {
    graph::Polyline way = graph_.findFreePath(link.vertex, GlobalGraph::home(), space);
    if (way.empty()) continue;
    if (way.front() != root_ || way.size() == 1) way.insert(way.begin(), root_);
    return way;
  }
  return {};
}

GraphLayer TrailHome::layer() const {
  GraphLayer layer = graph_.layer();
  layer.name = "trail";
  return layer;
}

void TrailHome::restore(const GraphLayer& layer) { graph_.restore(layer); }

}  // namespace spelunk::planners
