#pragma once

#include <vector>

#include "spelunk/planners/informed/graph_growth.h"

namespace spelunk::planners::informed {

/// Finds frontier that no vertex of the graph has in its box and adds vertices for it.
/// Differs from paper: there the sensor reaches as far as the boxes, so all frontier is in some
/// box; a sensor that sees farther leaves frontier where the robot has never been near.
class Scouting {
 public:
  explicit Scouting(const InformedParams& params) : params_(params) {}

  /// Adds up to `count` vertices at free places beside such frontier, those nearest to `from`
  /// first, each joined to the graph by a way of the motion planner. Returns how many. Places
  /// without a way are not tried again until forget().
  int scout(graph::VertexId from, int count, GraphGrowth& growth, const FrontierView& view,
            const PlanRequest& request, KnownSpace& space);

  /// Where frontier that no vertex has in its box was found, but no free place beside it.
  [[nodiscard]] std::vector<Eigen::Vector3d> seenFromAfar(const ReachabilityGraph& graph,
                                                          const FrontierView& view) const;

  void forget() { barren_.clear(); }
  [[nodiscard]] std::size_t barren() const { return barren_.size(); }

 private:
  struct Spot {
    Eigen::Vector3d place;
    double radius_m;
    bool has_place;
  };
  [[nodiscard]] std::vector<Eigen::Vector3d> uncovered(const Eigen::Vector3d& from,
                                                       const ReachabilityGraph& graph,
                                                       const FrontierView& view,
                                                       const AxisAlignedBox& bounds) const;
  [[nodiscard]] bool isCluster(const Eigen::Vector3d& voxel, const FrontierView& view) const;
  [[nodiscard]] bool isBarren(const Eigen::Vector3d& place) const;
  [[nodiscard]] bool join(graph::VertexId from, const Eigen::Vector3d& place, GraphGrowth& growth,
                          KnownSpace& space) const;

  InformedParams params_;
  std::vector<Spot> barren_;
};

}  // namespace spelunk::planners::informed
