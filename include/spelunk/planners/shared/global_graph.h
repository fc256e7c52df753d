#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/graph/shortest_paths.h"
#include "spelunk/graph/spatial_graph.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners {

/// A vertex from which unexplored space can be seen.
struct Frontier {
  graph::VertexId vertex{};
  double gain_m3 = 0.0;
  std::string closed_because;  ///< Empty: open. Else why it is not tried (again).

  [[nodiscard]] bool isOpen() const { return closed_because.empty(); }
};

struct GlobalGraphLimits {
  double spacing_m = 2.0;         ///< Vertices of an added path are at most this far apart.
  double merge_radius_m = 0.5;    ///< A vertex this near is used again.
  double connect_radius_m = 4.0;  ///< Added vertices are joined to those within it (densified).
  int connections_max = 12;
  double frontier_spacing_m = 3.0;
};

/// The lightweight graph of all the robot has come by and all it might go to (Dang 2020, section
/// 4.2, Alg. 4). Vertex 0 is home. Only edges that were free when added, or flown, are in it;
/// shortest ways are checked again before use, blocked edges are taken out.
class GlobalGraph {
 public:
  explicit GlobalGraph(const GlobalGraphLimits& limits) : limits_(limits) {}

  [[nodiscard]] bool isEmpty() const { return graph_.vertexCount() == 0; }
  [[nodiscard]] const graph::SpatialGraph& graph() const { return graph_; }
  [[nodiscard]] static graph::VertexId home() { return graph::VertexId{0}; }

  void setHome(const Eigen::Vector3d& position);  ///< Only on an empty graph.

  /// The vertex at (or within the merge radius of) a point, joined to its neighbours.
  graph::VertexId addPoint(const Eigen::Vector3d& point, const FreeSpace& space);

  /// AddPathToGraph: the path by vertices and edges, then extra free edges from each new vertex to
  /// its neighbours. The path must be free. Returns its last vertex.
  graph::VertexId addPath(const graph::Polyline& path, const FreeSpace& space);

  /// The next place the robot has been at: joined to the one before because it was flown.
  graph::VertexId addFlown(const Eigen::Vector3d& point, const FreeSpace& space);

  /// Marks a vertex as frontier unless one nearer than the frontier spacing is closed or promises
  /// at least half as much; open ones that promise less give way.
  void markFrontier(graph::VertexId vertex, double gain_m3);
  [[nodiscard]] bool hasFrontierNear(const Eigen::Vector3d& point, double gain_m3) const;
  [[nodiscard]] std::vector<Frontier>& frontiers() { return frontiers_; }
  [[nodiscard]] const std::vector<Frontier>& frontiers() const { return frontiers_; }
  /// Drops open frontiers whose gain is below `gain_m3`.
  void dropFrontiersBelow(double gain_m3);

  /// The shortest path between two vertices all of whose edges `space` finds free; blocked edges
  /// are removed on the way. Empty if there is none. Edges that were found free before are not
  /// looked at again until forgetChecksNear() says that the map there may have changed.
  [[nodiscard]] graph::Polyline findFreePath(graph::VertexId from, graph::VertexId to,
                                             const FreeSpace& space);
  /// Joins every vertex to its free neighbours as if it were new: the map may know more by now.
  void reconnect(const FreeSpace& space);
  void forgetChecksNear(const Eigen::Vector3d& point, double radius_m);

  [[nodiscard]] GraphLayer layer() const;
  void restore(const GraphLayer& layer);

 private:
  using Edge = std::pair<graph::VertexId, graph::VertexId>;

  std::optional<graph::VertexId> findMergeable(const Eigen::Vector3d& point) const;
  void connect(graph::VertexId vertex, const FreeSpace& space);
  void join(graph::VertexId a, graph::VertexId b);

  GlobalGraphLimits limits_;
  graph::SpatialGraph graph_;
  std::vector<Frontier> frontiers_;
  std::optional<graph::VertexId> last_flown_;
  std::set<Edge> checked_;
};

}  // namespace spelunk::planners
