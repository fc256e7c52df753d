#include "spelunk/planners/informed/scouting.h"

#include <algorithm>
#include <utility>

#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_place.h"

namespace spelunk::planners::informed {
namespace {

constexpr double kClusterSide_m = 2.0;
constexpr double kPlaceReach_m = 2.0;
constexpr double kPlaceStep_m = 0.4;
constexpr int kFailuresMax = 20;  // of the motion planner, in one call

std::vector<AxisAlignedBox> boxesOf(const ReachabilityGraph& graph) {
  std::vector<AxisAlignedBox> boxes;
  for (const graph::VertexId vertex : graph.vertices()) boxes.push_back(graph.boxOf(vertex));
  return boxes;
}

bool isCovered(const Eigen::Vector3d& place, const std::vector<AxisAlignedBox>& boxes) {
  return std::any_of(boxes.begin(), boxes.end(),
                     [&](const AxisAlignedBox& box) { return box.contains(place); });
}

}  // namespace

bool Scouting::isBarren(const Eigen::Vector3d& place) const {
  return std::any_of(barren_.begin(), barren_.end(), [&](const Spot& spot) {
    return (spot.place - place).squaredNorm() < spot.radius_m * spot.radius_m;
  });
}

/// Whether the frontier around a voxel is more than a few voxels.
bool Scouting::isCluster(const Eigen::Vector3d& voxel, const FrontierView& view) const {
  const auto cluster = boxAround(voxel, Eigen::Vector3d::Constant(kClusterSide_m));
  return view.frontier().countWithin(cluster) >=
         static_cast<std::size_t>(params_.frontier_voxels_min);
}

std::vector<Eigen::Vector3d> Scouting::seenFromAfar(const ReachabilityGraph& graph,
                                                    const FrontierView& view) const {
  std::vector<Eigen::Vector3d> places;
  const std::vector<AxisAlignedBox> boxes = boxesOf(graph);
  for (const Spot& spot : barren_)
    if (!spot.has_place && isCluster(spot.place, view) && !isCovered(spot.place, boxes))
      places.push_back(spot.place);
  return places;
}

/// Nearest first.
std::vector<Eigen::Vector3d> Scouting::uncovered(const Eigen::Vector3d& from,
                                                 const ReachabilityGraph& graph,
                                                 const FrontierView& view,
                                                 const AxisAlignedBox& bounds) const {
  const std::vector<AxisAlignedBox> boxes = boxesOf(graph);
  std::vector<std::pair<double, Eigen::Vector3d>> found;
  for (const map::VoxelIndex& voxel : view.frontier().within(bounds)) {
    const Eigen::Vector3d centre = view.credible().centreOf(voxel);
    if (!isCovered(centre, boxes)) found.emplace_back((centre - from).norm(), centre);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector3d> places;
  for (const auto& [distance, place] : found) places.push_back(place);
  return places;
}

int Scouting::scout(graph::VertexId from, int count, GraphGrowth& growth, const FrontierView& view,
                    const PlanRequest& request, KnownSpace& space) {
  const PlaceFinder places(kPlaceReach_m, kPlaceStep_m);
  const Eigen::Vector3d here = growth.graph().graph().position(from);
  std::vector<AxisAlignedBox> added;
  int failures = 0;
  for (const Eigen::Vector3d& voxel : uncovered(here, growth.graph(), view, request.bounds)) {
    if (static_cast<int>(added.size()) >= count || failures >= kFailuresMax) break;
    if (isCovered(voxel, added) || isBarren(voxel)) continue;
    if (!isCluster(voxel, view)) continue;
    const auto place = places.findRoomy(voxel, space);
    if (!place) {
      barren_.push_back({voxel, 0.5 * params_.sample_spacing_m, false});
    } else if (join(from, *place, growth, space)) {
      added.push_back(boxAround(*place, Eigen::Vector3d::Constant(2.0 * params_.range_m)));
    } else {
      ++failures;
      barren_.push_back({voxel, 0.5 * params_.range_m, true});
    }
  }
  return static_cast<int>(added.size());
}

bool Scouting::join(graph::VertexId from, const Eigen::Vector3d& place, GraphGrowth& growth,
                    KnownSpace& space) const {
  ReachabilityGraph& graph = growth.graph();
  const graph::VertexId near = *graph.graph().findNearest(place);
  const std::string stream =
      "scout/" + std::to_string(graph.graph().vertexCount()) + "/" + std::to_string(barren_.size());
  std::vector<graph::VertexId> anchors{near};
  if (near != from) anchors.push_back(from);
  for (const graph::VertexId anchor : anchors) {
    const auto answer = space.navigate(graph.graph().position(anchor), place, stream,
                                       navigation::TreeDetail::kLeaveOut);
    if (answer.status != navigation::NavigationStatus::kOk) continue;
    const graph::VertexId vertex = graph.insertVertex(place);
    graph.insertEdge(anchor, vertex, toLine(answer.path));
    return true;
  }
  return false;
}

}  // namespace spelunk::planners::informed
