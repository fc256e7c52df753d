#include "spelunk/planners/informed/frontier_survey.h"

#include <algorithm>

#include "spelunk/map/clearance.h"

namespace spelunk::planners::informed {
namespace {

/// How many of `voxels` are not among `known`; both in the order of isBefore().
std::size_t countNew(const std::vector<FrontierVoxel>& voxels,
                     const std::vector<map::VoxelIndex>& known) {
  std::size_t count = 0;
  auto next = known.begin();
  for (const FrontierVoxel& voxel : voxels) {
    while (next != known.end() && isBefore(*next, voxel.voxel)) ++next;
    if (next == known.end() || *next != voxel.voxel) ++count;
  }
  return count;
}

}  // namespace

std::vector<FrontierVoxel> FrontierSurvey::collect(const AxisAlignedBox& box) const {
  std::vector<FrontierVoxel> collected;
  const AxisAlignedBox region = intersection(box, request_.bounds);
  if (region.isEmpty()) return collected;
  for (const map::VoxelIndex& voxel : view_.frontier().within(region)) {
    const Eigen::Vector3d centre = view_.credible().centreOf(voxel);
    const bool is_forbidden =
        std::any_of(request_.zones.begin(), request_.zones.end(),
                    [&](const NoGoZone& zone) { return contains(zone, centre); });
    if (!is_forbidden) collected.push_back({voxel, 0.0F});
  }
  std::sort(collected.begin(), collected.end(), [](const FrontierVoxel& a, const FrontierVoxel& b) {
    return isBefore(a.voxel, b.voxel);
  });
  return collected;
}

bool FrontierSurvey::hasFrontier(const AxisAlignedBox& box) const {
  const AxisAlignedBox region = intersection(box, request_.bounds);
  return !region.isEmpty() && view_.frontier().countWithin(region) > 0;
}

std::vector<graph::VertexId> FrontierSurvey::refresh(ReachabilityGraph& graph) const {
  std::vector<graph::VertexId> observed;
  for (const graph::VertexId vertex : graph.vertices()) {
    const AxisAlignedBox box = graph.boxOf(vertex);
    VertexLabel& label = graph.update(vertex);
    const std::uint64_t change = view_.frontier().lastChangeNear(box);
    if (change == label.surveyed && change != 0) continue;
    const bool lost_any = std::any_of(
        label.frontier.begin(), label.frontier.end(),
        [&](const FrontierVoxel& voxel) { return !view_.frontier().contains(voxel.voxel); });
    if (lost_any) observed.push_back(vertex);
    label.surveyed = change;
    label.frontier = collect(box);
    label.is_measured = false;
    judge(label);
  }
  return observed;
}

void FrontierSurvey::judge(VertexLabel& label) const {
  const auto enough = static_cast<std::size_t>(params_.frontier_voxels_min);
  const bool was_closed = !label.closed_because.empty();
  if (was_closed && countNew(label.frontier, label.closed_voxels) < enough) return;
  label.closed_because.clear();
  label.closed_voxels.clear();
  label.is_explored = label.frontier.size() < enough;
}

void FrontierSurvey::measure(ReachabilityGraph& graph, graph::VertexId vertex) const {
  VertexLabel& label = graph.update(vertex);
  if (label.is_measured) return;
  label.is_measured = true;
  if (label.frontier.empty()) return;
  AxisAlignedBox around = {Eigen::Vector3d::Constant(1e9), Eigen::Vector3d::Constant(-1e9)};
  for (const FrontierVoxel& voxel : label.frontier) {
    const Eigen::Vector3d centre = view_.credible().centreOf(voxel.voxel);
    around = hull(around, {centre, centre});
  }
  const double limit = params_.clearance_max_m;
  const map::LocalWindow window(*request_.map,
                                {around.min.array() - limit, around.max.array() + limit});
  const map::ClearanceField clearance(window, limit);
  for (FrontierVoxel& voxel : label.frontier)
    voxel.clearance_m = static_cast<float>(clearance.at(view_.credible().centreOf(voxel.voxel)));
}

}  // namespace spelunk::planners::informed
