#pragma once

#include <vector>

#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/informed/informed_params.h"
#include "spelunk/planners/informed/reachability_graph.h"
#include "spelunk/planners/shared/frontier_view.h"

namespace spelunk::planners::informed {

/// Collects the frontier voxels of vertices from the map of one request; only voxels inside the
/// bounds and outside all zones count. A view for the duration of one plan.
class FrontierSurvey {
 public:
  FrontierSurvey(const FrontierView& view, const PlanRequest& request, const InformedParams& params)
      : view_(view), request_(request), params_(params) {}

  [[nodiscard]] bool hasFrontier(const AxisAlignedBox& box) const;

  /// Brings F(v) of every vertex up to date where the frontier changed. A vertex with too few
  /// voxels is explored; a closed one is opened again when enough new voxels have turned up.
  /// Returns the observed vertices: those some of whose voxels are no frontier any longer.
  std::vector<graph::VertexId> refresh(ReachabilityGraph& graph) const;

  /// Fills in the clearances of a vertex's voxels, if they are not known yet.
  void measure(ReachabilityGraph& graph, graph::VertexId vertex) const;

 private:
  [[nodiscard]] std::vector<FrontierVoxel> collect(const AxisAlignedBox& box) const;
  void judge(VertexLabel& label) const;

  const FrontierView& view_;
  const PlanRequest& request_;
  const InformedParams& params_;
};

}  // namespace spelunk::planners::informed
