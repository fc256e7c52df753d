#include "spelunk/planners/informed/graph_growth.h"

#include <algorithm>

#include "spelunk/planners/shared/flight_line.h"

namespace spelunk::planners::informed {
namespace {

using graph::FoundPath;
using graph::Polyline;
using graph::VertexId;

constexpr double kMergeShare = 0.3;     // of d_max: a vertex this near is the same place
constexpr double kWorthALoop = 2.5;     // a way along the graph this much longer than straight
constexpr double kWorthKeeping = 0.75;  // of the way along the graph

}  // namespace

VertexId GraphGrowth::grow(const PlanRequest& request, const Eigen::Vector3d& root,
                           const FrontierSurvey& survey, KnownSpace& space) {
  if (graph_.isEmpty()) {
    last_ = graph_.insertVertex(request.home.position);
    flown_ = {request.home.position};
  }
  observed_ = survey.refresh(graph_);
  for (const StampedPose& stamped : request.trail) {
    if (stamped.time_s <= known_until_s_) continue;
    const Eigen::Vector3d& place = stamped.pose.position;
    since_looked_m_ += (place - flown_.back()).norm();
    flown_.push_back(place);
    known_until_s_ = stamped.time_s;
    if (since_looked_m_ < params_.range_m) continue;
    since_looked_m_ = 0.0;
    if (survey.hasFrontier(boxAround(place, Eigen::Vector3d::Constant(2.0 * params_.range_m))))
      addVertex(place, space);
  }
  known_until_s_ = std::max(known_until_s_, request.time_s);
  since_looked_m_ = 0.0;
  flown_.push_back(root);
  const VertexId here = addVertex(root, space);
  survey.refresh(graph_);
  return here;
}

/// The end of what was flown becomes a vertex, or the one beside it takes its place.
VertexId GraphGrowth::addVertex(const Eigen::Vector3d& position, KnownSpace& space) {
  const auto near = graph_.graph().findWithin(position, kMergeShare * params_.range_m);
  for (const VertexId vertex : near) {
    const Eigen::Vector3d& place = graph_.graph().position(vertex);
    const bool is_here = (place - position).norm() < 1e-9;
    if (!is_here && !space.free().isFree(position, place)) continue;
    flown_.push_back(place);
    if (vertex != last_) graph_.insertEdge(last_, vertex, flown_);
    last_ = vertex;
    flown_ = {place};
    return vertex;
  }
  const VertexId vertex = graph_.insertVertex(position);
  graph_.insertEdge(last_, vertex, flown_);
  last_ = vertex;
  flown_ = {position};
  joinObserved(vertex, space);
  return vertex;
}

void GraphGrowth::joinObserved(VertexId vertex, KnownSpace& space) {
  const AxisAlignedBox box = graph_.boxOf(vertex);
  for (const VertexId other : observed_) {
    const AxisAlignedBox common = intersection(box, graph_.boxOf(other));
    if (other != vertex && !common.isEmpty() && !graph_.graph().hasEdge(vertex, other))
      join(vertex, other, space);
  }
}

void GraphGrowth::join(VertexId a, VertexId b, KnownSpace& space) {
  const Eigen::Vector3d& from = graph_.graph().position(a);
  const Eigen::Vector3d& to = graph_.graph().position(b);
  if (space.free().isFree(from, to)) return graph_.insertEdge(a, b, {from, to});
  const double along_graph = graph_.cheapestPath(a, b).length;
  if (along_graph < kWorthALoop * (to - from).norm()) return;
  const std::string stream =
      "join/" + std::to_string(graph::indexOf(a)) + "/" + std::to_string(graph::indexOf(b));
  const auto answer = space.navigate(from, to, stream, navigation::TreeDetail::kLeaveOut);
  if (answer.status != navigation::NavigationStatus::kOk) return;
  if (lengthOf(answer.path) < kWorthKeeping * along_graph)
    graph_.insertEdge(a, b, toLine(answer.path));
}

bool GraphGrowth::isUsable(VertexId a, VertexId b, KnownSpace& space) {
  const std::pair<VertexId, VertexId> edge = std::minmax(a, b);
  if (checked_.count(edge) != 0) return true;
  const Polyline way = graph_.wayOf(edge.first, edge.second);
  if (!space.isFree(way)) {
    graph_.removeEdge(a, b);
    const std::string stream = "mend/" + std::to_string(graph::indexOf(edge.first)) + "/" +
                               std::to_string(graph::indexOf(edge.second));
    const auto answer =
        space.navigate(way.front(), way.back(), stream, navigation::TreeDetail::kLeaveOut);
    if (answer.status == navigation::NavigationStatus::kOk && space.isFree(toLine(answer.path)))
      graph_.insertEdge(edge.first, edge.second, toLine(answer.path));
    else
      return false;
  }
  checked_.insert(edge);
  return true;
}

Polyline GraphGrowth::freeWay(VertexId from, VertexId to, KnownSpace& space) {
  for (;;) {
    const FoundPath path = graph_.cheapestPath(from, to);
    if (!path.isFound()) return {};
    bool is_usable = true;
    for (std::size_t i = 1; i < path.vertices.size(); ++i)
      is_usable = isUsable(path.vertices[i - 1], path.vertices[i], space) && is_usable;
    if (is_usable) return graph_.lineOf(path);
  }
}

void GraphGrowth::rejoinHome(VertexId here, KnownSpace& space) {
  const VertexId home = ReachabilityGraph::home();
  if (graph_.cheapestPath(here, home).isFound()) return;
  const Eigen::Vector3d& place = graph_.graph().position(here);
  for (const VertexId other : graph_.graph().findWithin(place, 2.0 * params_.range_m)) {
    const Eigen::Vector3d& beside = graph_.graph().position(other);
    if (!graph_.cheapestPath(other, home).isFound() || !space.free().isFree(place, beside))
      continue;
    return graph_.insertEdge(here, other, {place, beside});
  }
  const auto answer = space.navigate(place, graph_.graph().position(home), "rejoin home",
                                     navigation::TreeDetail::kLeaveOut);
  if (answer.status == navigation::NavigationStatus::kOk)
    graph_.insertEdge(here, home, toLine(answer.path));
}

void GraphGrowth::forgetChecksNear(const Eigen::Vector3d& place, double radius_m) {
  for (auto edge = checked_.begin(); edge != checked_.end();) {
    const bool joined = graph_.graph().hasEdge(edge->first, edge->second);
    const Polyline way = joined ? graph_.wayOf(edge->first, edge->second) : Polyline{};
    const bool is_near = std::any_of(way.begin(), way.end(), [&](const Eigen::Vector3d& point) {
      return (point - place).norm() < radius_m;
    });
    edge = is_near || !joined ? checked_.erase(edge) : std::next(edge);
  }
}

void GraphGrowth::restore(const GraphLayer& layer) {
  graph_.restore(layer);
  checked_.clear();
  observed_.clear();
  if (graph_.isEmpty()) return;
  last_ = ReachabilityGraph::home();
  flown_ = {graph_.graph().position(last_)};
}

}  // namespace spelunk::planners::informed
