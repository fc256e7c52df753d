#include "spelunk/graph/a_star.h"

#include <algorithm>
#include <boost/graph/astar_search.hpp>
#include <limits>

#include "boost_view.h"
#include "spelunk/common/contract.h"

namespace spelunk::graph {
namespace {

VertexId idOf(std::size_t i) { return VertexId{static_cast<std::uint32_t>(i)}; }

class StraightDistance : public boost::astar_heuristic<BoostView, double> {
 public:
  StraightDistance(const SpatialGraph& graph, VertexId goal) : graph_(&graph), goal_(goal) {}
  double operator()(std::size_t vertex) const {
    return (graph_->position(idOf(vertex)) - graph_->position(goal_)).norm();
  }

 private:
  const SpatialGraph* graph_;
  VertexId goal_;
};

struct GoalReached {};

class StopAtGoal : public boost::default_astar_visitor {
 public:
  explicit StopAtGoal(VertexId goal) : goal_(indexOf(goal)) {}
  void examine_vertex(std::size_t vertex, const BoostView& /*graph*/) const {
    if (vertex == goal_) throw GoalReached{};  // Boost's own way to end a search early
  }

 private:
  std::size_t goal_;
};

}  // namespace

FoundPath findShortestPath(const SpatialGraph& graph, VertexId from, VertexId to) {
  require(indexOf(from) < graph.vertexCount() && indexOf(to) < graph.vertexCount(),
          "findShortestPath: no such vertex");
  FoundPath found;
  found.length = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> before(graph.vertexCount());
  std::vector<double> distance(graph.vertexCount(), found.length);
  try {
    const boost::typed_identity_property_map<std::size_t> number;
    boost::astar_search(BoostView(graph), indexOf(from), StraightDistance(graph, to),
                        boost::vertex_index_map(number)
                            .weight_map(BoostView::Weights{})
                            .predecessor_map(before.data())
                            .distance_map(distance.data())
                            .distance_inf(found.length)
                            .visitor(StopAtGoal(to)));
  } catch (const GoalReached&) {
    found.length = distance[indexOf(to)];
    for (std::size_t at = indexOf(to); at != indexOf(from); at = before[at])
      found.vertices.push_back(idOf(at));
    found.vertices.push_back(from);
    std::reverse(found.vertices.begin(), found.vertices.end());
  }
  return found;
}

}  // namespace spelunk::graph
