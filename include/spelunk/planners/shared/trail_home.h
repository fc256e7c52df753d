#pragma once

#include <limits>
#include <vector>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/free_space.h"
#include "spelunk/planners/shared/global_graph.h"

namespace spelunk::planners {

/// The way home along the robot's own trail, its paths and their free short cuts, for planners that
/// have no graph of their own to find it in.
class TrailHome {
 public:
  /// Takes up what the request's trail has beyond the last one's; ways home begin at `root` now.
  void follow(const PlanRequest& request, const Eigen::Vector3d& root, const FreeSpace& space);

  /// A free path that the robot will follow, so that there is a way home from its end too.
  void expect(const graph::Polyline& path, const FreeSpace& space);

  /// Length of the shortest way home as far as is known, its old edges unchecked; infinite if there
  /// is none.
  [[nodiscard]] double metres() const;

  /// The shortest way home whose every edge is free now; empty if there is none.
  [[nodiscard]] graph::Polyline findWay(const FreeSpace& space);

  [[nodiscard]] GraphLayer layer() const;  ///< "trail"
  void restore(const GraphLayer& layer);

 private:
  /// A vertex that the root can go to.
  struct Link {
    graph::VertexId vertex{};
    double length_m = 0.0;
  };
  void linkUp(const FreeSpace& space);
  void measure();
  [[nodiscard]] double metresBy(const Link& link) const;
  [[nodiscard]] graph::Polyline findKnownWay(const FreeSpace& space);

  GlobalGraph graph_{GlobalGraphLimits{2.0, 0.2, 4.0, 12, 3.0}};
  std::vector<Link> links_;
  std::vector<double> home_m_;  ///< From each vertex.
  Eigen::Vector3d root_ = Eigen::Vector3d::Zero();
  double known_until_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace spelunk::planners
