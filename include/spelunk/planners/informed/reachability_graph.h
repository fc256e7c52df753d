#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/graph/a_star.h"
#include "spelunk/graph/path_similarity.h"
#include "spelunk/graph/spatial_graph.h"
#include "spelunk/map/occupancy.h"
#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners::informed {

/// A frontier voxel of a vertex.
struct FrontierVoxel {
  map::VoxelIndex voxel;
  float clearance_m = 0.0F;  ///< To the nearest obstacle; 0 until measured.
};

/// F(v) of Akbari 2021, section V: what a vertex knows of the frontier around it.
struct VertexLabel {
  std::vector<FrontierVoxel> frontier;  ///< W, in the order of isBefore().
  bool is_explored = false;             ///< exp
  std::string closed_because;           ///< Why it is explored though voxels are left.
  bool is_over_budget = false;          ///< Closed for want of time.
  Eigen::Vector3d closed_from = Eigen::Vector3d::Zero();  ///< Where the robot was then.

  bool is_measured = false;                    ///< Whether the clearances are filled in.
  std::uint64_t surveyed = 0;                  ///< The frontier's change that W was collected at.
  std::vector<map::VoxelIndex> closed_voxels;  ///< W when it was closed.
  double best_gain_m3 = 0.0;                   ///< Of the samples looked at when it was closed.
};

/// The order of frontier voxels: by place only.
[[nodiscard]] bool isBefore(const map::VoxelIndex& a, const map::VoxelIndex& b);

/// A vertex that is not explored and how far it is along the graph.
struct RankedVertex {
  graph::VertexId vertex{};
  double distance_m = 0.0;
};

/// The double weighted reachability graph G = (V, E, F, C) (Akbari 2021, section V). Vertices stand
/// where the robot was; an edge holds the way between its two, whose length is its cost. Vertex 0
/// is home.
class ReachabilityGraph {
 public:
  /// `range_m`: half the side of the boxes around vertices [d_max].
  explicit ReachabilityGraph(double range_m) : range_m_(range_m) {}

  [[nodiscard]] bool isEmpty() const { return labels_.empty(); }
  [[nodiscard]] const graph::SpatialGraph& graph() const { return graph_; }
  [[nodiscard]] static graph::VertexId home() { return graph::VertexId{0}; }
  [[nodiscard]] std::vector<graph::VertexId> vertices() const;
  /// The box of side 2 d_max in which a vertex collects frontier voxels.
  [[nodiscard]] AxisAlignedBox boxOf(graph::VertexId vertex) const;

  graph::VertexId insertVertex(const Eigen::Vector3d& position);

  /// Insert(e, v, v'): `way` leads from v to v'; its length is the cost. A cheaper way replaces one
  /// that is there, a dearer one is dropped. Throws Precondition unless the way begins and ends at
  /// the vertices.
  void insertEdge(graph::VertexId from, graph::VertexId to, graph::Polyline way);
  void removeEdge(graph::VertexId a, graph::VertexId b);

  /// Query: the way from v to v', which must be joined, and F(v).
  [[nodiscard]] graph::Polyline wayOf(graph::VertexId from, graph::VertexId to) const;
  [[nodiscard]] const VertexLabel& labelOf(graph::VertexId vertex) const;

  /// Update(v).
  [[nodiscard]] VertexLabel& update(graph::VertexId vertex) { return labels_[indexOf(vertex)]; }

  /// P(v, v'): the cheapest path, by A*.
  [[nodiscard]] graph::FoundPath cheapestPath(graph::VertexId from, graph::VertexId to) const {
    return graph::findShortestPath(graph_, from, to);
  }
  /// The ways of all its edges joined.
  [[nodiscard]] graph::Polyline lineOf(const graph::FoundPath& path) const;

  /// Rank(G, v): the vertices that are not explored and can be reached, nearest first.
  [[nodiscard]] std::vector<RankedVertex> rank(graph::VertexId from) const;

  /// Layer "reachability": unexplored vertices are its frontier.
  [[nodiscard]] GraphLayer layer() const;
  /// Takes up the vertices and edges of such a layer; ways are straight. Replaces what is there.
  void restore(const GraphLayer& layer);

 private:
  using Edge = std::pair<graph::VertexId, graph::VertexId>;

  double range_m_;
  graph::SpatialGraph graph_;
  std::vector<VertexLabel> labels_;
  std::map<Edge, graph::Polyline> ways_;  ///< From the smaller vertex to the larger one.
};

}  // namespace spelunk::planners::informed
