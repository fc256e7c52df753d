#include "spelunk/planners/shared/global_graph.h"

#include <algorithm>
#include <iterator>

#include "spelunk/common/contract.h"
#include "spelunk/graph/a_star.h"

namespace spelunk::planners {

using graph::Polyline;
using graph::VertexId;

namespace {

/// The vertices of a path and points between them, at most `spacing_m` apart.
Polyline subdivided(const Polyline& path, double spacing_m) {
  Polyline line{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Polyline edge = graph::resampled({path[i - 1], path[i]}, spacing_m);
    line.insert(line.end(), edge.begin() + 1, edge.end());
  }
  return line;
}

}  // namespace

void GlobalGraph::setHome(const Eigen::Vector3d& position) {
  require(isEmpty(), "GlobalGraph: home must be the first vertex");
  last_flown_ = graph_.addVertex(position);
}

std::optional<VertexId> GlobalGraph::findMergeable(const Eigen::Vector3d& point) const {
  const auto nearest = graph_.findNearest(point);
  if (!nearest || (graph_.position(*nearest) - point).norm() > limits_.merge_radius_m)
    return std::nullopt;
  return nearest;
}

void GlobalGraph::join(VertexId a, VertexId b) {
  if (a != b) graph_.addEdge(a, b, (graph_.position(a) - graph_.position(b)).norm());
}

void GlobalGraph::connect(VertexId vertex, const FreeSpace& space) {
  const Eigen::Vector3d point = graph_.position(vertex);
  int tried = 0;
  for (const VertexId near : graph_.findWithin(point, limits_.connect_radius_m)) {
    if (near == vertex || graph_.hasEdge(near, vertex)) continue;
    if (++tried > limits_.connections_max) return;
    if (space.isFree(point, graph_.position(near))) join(vertex, near);
  }
}

void GlobalGraph::reconnect(const FreeSpace& space) {
  for (std::size_t i = 0; i < graph_.vertexCount(); ++i)
    connect(VertexId{static_cast<std::uint32_t>(i)}, space);
}

VertexId GlobalGraph::addPoint(const Eigen::Vector3d& point, const FreeSpace& space) {
  const auto existing = findMergeable(point);
  if (existing && space.isFree(point, graph_.position(*existing))) {
    connect(*existing, space);
    return *existing;
  }
  const VertexId added = graph_.addVertex(point);
  connect(added, space);
  return added;
}

VertexId GlobalGraph::addPath(const Polyline& path, const FreeSpace& space) {
  require(!path.empty(), "GlobalGraph: empty path");
  const Polyline line = subdivided(path, limits_.spacing_m);
  std::optional<VertexId> last;
  for (std::size_t k = 0; k < line.size(); ++k) {
    // An old vertex beside the line takes the place of a new one if the path stays free through it.
    const auto old = findMergeable(line[k]);
    const bool takes_old =
        old && space.isFree(last ? graph_.position(*last) : line[k], graph_.position(*old)) &&
        (k + 1 == line.size() || space.isFree(graph_.position(*old), line[k + 1]));
    const VertexId next = takes_old ? *old : graph_.addVertex(line[k]);
    if (last) join(*last, next);
    if (!takes_old) connect(next, space);
    last = next;
  }
  return *last;
}

VertexId GlobalGraph::addFlown(const Eigen::Vector3d& point, const FreeSpace& space) {
  const VertexId vertex = addPoint(point, space);
  if (last_flown_) join(*last_flown_, vertex);
  last_flown_ = vertex;
  return vertex;
}

bool GlobalGraph::hasFrontierNear(const Eigen::Vector3d& point, double gain_m3) const {
  constexpr double kMuchMore = 2.0;  // so much better is another frontier
  return std::any_of(frontiers_.begin(), frontiers_.end(), [&](const Frontier& frontier) {
    return (graph_.position(frontier.vertex) - point).norm() < limits_.frontier_spacing_m &&
           (!frontier.isOpen() || gain_m3 <= kMuchMore * frontier.gain_m3);
  });
}

void GlobalGraph::markFrontier(VertexId vertex, double gain_m3) {
  const Eigen::Vector3d& point = graph_.position(vertex);
  if (hasFrontierNear(point, gain_m3)) return;
  frontiers_.erase(std::remove_if(frontiers_.begin(), frontiers_.end(),
                                  [&](const Frontier& frontier) {
                                    return frontier.isOpen() &&
                                           (graph_.position(frontier.vertex) - point).norm() <
                                               limits_.frontier_spacing_m;
                                  }),
                   frontiers_.end());
  frontiers_.push_back({vertex, gain_m3, ""});
}

void GlobalGraph::dropFrontiersBelow(double gain_m3) {
  frontiers_.erase(std::remove_if(frontiers_.begin(), frontiers_.end(),
                                  [gain_m3](const Frontier& frontier) {
                                    return frontier.isOpen() && frontier.gain_m3 < gain_m3;
                                  }),
                   frontiers_.end());
}

Polyline GlobalGraph::findFreePath(VertexId from, VertexId to, const FreeSpace& space) {
  for (;;) {
    const std::vector<VertexId> way = graph::findShortestPath(graph_, from, to).vertices;
    bool is_free = !way.empty();
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Edge edge{std::min(way[i - 1], way[i]), std::max(way[i - 1], way[i])};
      if (checked_.count(edge) > 0) continue;
      if (space.isFree(graph_.position(way[i - 1]), graph_.position(way[i]))) {
        checked_.insert(edge);
      } else {
        graph_.removeEdge(way[i - 1], way[i]);
        is_free = false;
      }
    }
    if (way.empty()) return {};
    if (!is_free) continue;
    Polyline path;
    for (const VertexId id : way) path.push_back(graph_.position(id));
    return path;
  }
}

void GlobalGraph::forgetChecksNear(const Eigen::Vector3d& point, double radius_m) {
  for (auto it = checked_.begin(); it != checked_.end();) {
    const bool is_near = (graph_.position(it->first) - point).norm() < radius_m;
    it = is_near ? checked_.erase(it) : std::next(it);
  }
}

GraphLayer GlobalGraph::layer() const {
  GraphLayer layer{"global", {}, {}};
  for (std::size_t i = 0; i < graph_.vertexCount(); ++i)
    layer.vertices.push_back(
        {graph_.position(VertexId{static_cast<std::uint32_t>(i)}), 0.0, false});
  for (const Frontier& frontier : frontiers_) {
    GraphVertex& vertex = layer.vertices[indexOf(frontier.vertex)];
    vertex.gain_m3 = frontier.gain_m3;
    vertex.is_frontier = frontier.isOpen();
  }
  for (const auto& [a, b] : graph_.edges())
    layer.edges.emplace_back(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  return layer;
}

void GlobalGraph::restore(const GraphLayer& layer) {
  *this = GlobalGraph(limits_);
  for (const GraphVertex& vertex : layer.vertices) {
    const VertexId id = graph_.addVertex(vertex.position);
    if (vertex.is_frontier) frontiers_.push_back({id, vertex.gain_m3, ""});
  }
  for (const auto& [a, b] : layer.edges) join(VertexId{a}, VertexId{b});
}

}  // namespace spelunk::planners
