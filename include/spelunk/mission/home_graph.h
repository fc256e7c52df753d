#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/graph/shortest_paths.h"
#include "spelunk/graph/spatial_graph.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/path_monitor.h"

namespace spelunk::mission {

/// All ways home that are known for sure: the robot's own trail, shortcuts where it passes itself
/// within a free straight line, and checked ways of the planner. Kept up with the map: what becomes
/// occupied cuts edges. Flown edges count with a tighter box once the robot's full box no longer
/// fits, for it has been there; they are then used only where nothing else is left.
class HomeGraph {
 public:
  /// Whether a robot with legs finds footing on the straight way between two places.
  using Footing =
      std::function<bool(const map::FrozenMap&, const Eigen::Vector3d&, const Eigen::Vector3d&)>;

  /// `box`: the robot's, full extents, metres, margin included. `footing`: asked before a shortcut
  /// is taken up; empty for robots that fly.
  HomeGraph(const Pose& home, const Eigen::Vector3d& box, double resolution_m,
            Footing footing = {});

  /// The box that flown edges are checked with in the last resort.
  [[nodiscard]] static Eigen::Vector3d tightBox(const Eigen::Vector3d& box) {
    return kTightShare * box;
  }

  /// Where the robot is; kept when half a metre from the last kept place.
  void addTrail(const Pose& pose);
  /// A path known to be free that begins near the trail; its waypoints join the graph.
  void addRoute(const Path& route);
  /// Cuts for good the edges that meet a no-go zone, unless the robot itself came that way, and
  /// keeps later ones from meeting it.
  void noteZone(const NoGoZone& zone);
  /// Cuts the edges that the box could not fly any more. True if there were such edges.
  bool noteOccupied(const std::vector<map::VoxelIndex>& voxels);
  /// Tries shortcuts from the places added since the last call and takes up cut edges that are free
  /// again (some a call).
  void connect(const std::shared_ptr<const map::FrozenMap>& map);
  /// The same for every cut edge; for when no way is left.
  void recheckAll(const std::shared_ptr<const map::FrozenMap>& map);

  /// The shortest known way from a pose to home, first waypoint `from`, last one home; none if the
  /// graph is cut.
  [[nodiscard]] std::optional<Path> wayFrom(const Pose& from);

  /// Places that home is still reachable from, nearest to `from` first, some metres apart.
  [[nodiscard]] std::vector<Pose> placesBeforeHome(const Pose& from);
  /// Where the trail is cut: the middle of the cut part nearest to `from` that has home on one side
  /// only; none if there is no such part with open trail on both sides.
  [[nodiscard]] std::optional<Eigen::Vector3d> findCut(const Pose& from);

  [[nodiscard]] const Path& trail() const { return trail_; }
  [[nodiscard]] const Pose& home() const { return trail_.front(); }
  [[nodiscard]] std::size_t size() const { return graph_.vertexCount(); }

 private:
  enum class EdgeState { kOpen, kTight, kCut };
  struct Edge {
    graph::VertexId a{};
    graph::VertexId b{};
    bool is_flown = false;
    bool is_forbidden = false;
    EdgeState state = EdgeState::kOpen;
  };
  enum class Origin { kFlown, kChecked };

  void addEdge(graph::VertexId a, graph::VertexId b, Origin origin);
  void setState(Edge& edge, EdgeState state);
  void use(const std::shared_ptr<const map::FrozenMap>& map);
  void tryShortcuts(graph::VertexId id, const map::FrozenMap& map);
  void recheck(Edge& edge);
  [[nodiscard]] bool isFree(graph::VertexId a, graph::VertexId b,
                            map::ConfigurationSpace& space) const;
  [[nodiscard]] bool isForbidden(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  const graph::ShortestPaths& fromHome();

  Eigen::Vector3d box_;
  Footing footing_;
  graph::SpatialGraph graph_;
  std::vector<Edge> edges_;
  std::vector<NoGoZone> zones_;
  map::ConfigurationSpace space_;
  map::ConfigurationSpace tight_space_;
  navigation::SweptIndex swept_;
  navigation::SweptIndex swept_tight_;
  Path trail_;
  graph::VertexId last_trail_vertex_{};
  std::size_t next_to_connect_ = 1;
  std::vector<std::uint32_t> cut_;  ///< Edges that are not open, oldest first.
  std::optional<graph::ShortestPaths> from_home_;
};

}  // namespace spelunk::mission
