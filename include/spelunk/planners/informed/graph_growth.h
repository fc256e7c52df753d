#pragma once

#include <limits>
#include <set>
#include <utility>

#include "spelunk/planners/informed/frontier_survey.h"
#include "spelunk/planners/informed/reachability_graph.h"
#include "spelunk/planners/shared/known_space.h"

namespace spelunk::planners::informed {

/// Grows the reachability graph along what the robot flies (ExpGraph of Akbari 2021, Alg. 1, line
/// 14; section V) and keeps its ways true to the map.
class GraphGrowth {
 public:
  explicit GraphGrowth(const InformedParams& params) : params_(params), graph_(params.range_m) {}

  [[nodiscard]] ReachabilityGraph& graph() { return graph_; }
  [[nodiscard]] const ReachabilityGraph& graph() const { return graph_; }

  /// Takes up what was flown since the last call: a vertex every d_max of it whose box holds
  /// frontier voxels, and one at `root`, where the plan begins, unless there is one beside it.
  /// Each new vertex is joined to the one before by the way flown, and to the observed vertices in
  /// reach. Returns the vertex at the root.
  graph::VertexId grow(const PlanRequest& request, const Eigen::Vector3d& root,
                       const FrontierSurvey& survey, KnownSpace& space);

  /// The cheapest way between two vertices that is still free. Edges that are not are led another
  /// way by navigation, or removed. Empty if there is none.
  [[nodiscard]] graph::Polyline freeWay(graph::VertexId from, graph::VertexId to,
                                        KnownSpace& space);

  /// Edges that were not free any more may have cut `here` off from home: it is joined again to the
  /// nearest vertex in straight reach that is not cut off, else to home by navigation. Nothing
  /// happens where neither works or nothing was cut.
  void rejoinHome(graph::VertexId here, KnownSpace& space);

  /// Ways that come within `radius_m` of a place are checked again before they are used.
  void forgetChecksNear(const Eigen::Vector3d& place, double radius_m);

  void restore(const GraphLayer& layer);

 private:
  graph::VertexId addVertex(const Eigen::Vector3d& position, KnownSpace& space);
  void joinObserved(graph::VertexId vertex, KnownSpace& space);
  void join(graph::VertexId a, graph::VertexId b, KnownSpace& space);
  [[nodiscard]] bool isUsable(graph::VertexId a, graph::VertexId b, KnownSpace& space);

  InformedParams params_;
  ReachabilityGraph graph_;
  graph::VertexId last_{};
  graph::Polyline flown_;  ///< From the last vertex on.
  double since_looked_m_ = 0.0;
  double known_until_s_ = -std::numeric_limits<double>::infinity();
  std::vector<graph::VertexId> observed_;
  std::set<std::pair<graph::VertexId, graph::VertexId>> checked_;
};

}  // namespace spelunk::planners::informed
