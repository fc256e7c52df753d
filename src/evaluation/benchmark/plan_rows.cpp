#include <algorithm>
#include <cmath>

#include "bench.h"
#include "map/template_rays.h"
#include "spelunk/graph/shortest_paths.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::benchmark {
namespace {

const Eigen::Vector3d kBox(1.4, 1.4, 0.5);
constexpr std::size_t kVertices = 500;
constexpr std::size_t kEdges = 5000;
constexpr double kEdgeLength_m = 3.0;

/// What one plan decides on: the graph, its shortest paths and the gain of every vertex.
struct Plan {
  std::vector<std::pair<graph::VertexId, graph::VertexId>> edges;
  std::vector<double> distances;
  std::vector<int> unknown_voxels;
  std::size_t tried_edges = 0;
};

/// The steps both ways share; they differ in how an edge is checked and a gain is counted.
template <class IsEdgeFree, class GainAt>
Plan makePlan(const std::vector<Eigen::Vector3d>& vertices, IsEdgeFree&& isEdgeFree,
              GainAt&& gainAt) {
  Plan plan;
  graph::SpatialGraph graph;
  for (const Eigen::Vector3d& vertex : vertices) {
    const graph::VertexId id = graph.addVertex(vertex);
    for (const graph::VertexId near : graph.findWithin(vertex, kEdgeLength_m)) {
      if (near == id || plan.tried_edges == kEdges) continue;
      ++plan.tried_edges;
      const Eigen::Vector3d& other = graph.position(near);
      if (isEdgeFree(other, vertex)) graph.addEdge(near, id, (vertex - other).norm());
    }
  }
  const graph::ShortestPaths paths = graph::shortestPaths(graph, graph::VertexId{0});
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    plan.distances.push_back(paths.distanceTo(graph::VertexId{static_cast<std::uint32_t>(i)}));
    plan.unknown_voxels.push_back(gainAt(vertices[i]));
  }
  plan.edges = graph.edges();
  return plan;
}

/// Free boxes around the middle, as near together as makes 5000 edges of at most 3 m.
std::vector<Eigen::Vector3d> sampleVertices(const map::LocalWindow& window,
                                            map::ConfigurationSpace space,
                                            const Eigen::Vector3d& middle) {
  Rng rng(9);
  std::vector<Eigen::Vector3d> vertices;
  while (vertices.size() < kVertices) {
    const Eigen::Vector3d point = freePoint(window, rng, middle, {15.0, 15.0, 2.0});
    if (space.isFree(point)) vertices.push_back(point);
  }
  return vertices;
}

int unknownInLists(const octomap::OcTree& tree, const map::TemplateRays& rays,
                   const map::VoxelIndex& start) {
  int unknown = 0;
  for (const auto& ray : rays.rays())
    for (std::uint32_t i = ray.begin; i < ray.end; ++i) {
      const auto& step = rays.steps()[i];
      const auto status = statusIn(tree, start + map::VoxelIndex(step[0], step[1], step[2]));
      if (status == map::Occupancy::kOccupied) break;
      unknown += status == map::Occupancy::kUnknown ? 1 : 0;
    }
  return unknown;
}

Plan planOurs(KnownMine& mine, const map::GainEvaluator& evaluator, const AxisAlignedBox& region,
              const std::vector<Eigen::Vector3d>& vertices) {
  const auto frozen = mine.map.freeze();
  const map::LocalWindow window(*frozen, region);
  map::ConfigurationSpace space(kBox, frozen);
  return makePlan(
      vertices,
      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return space.isSweepFree(a, b); },
      [&](const Eigen::Vector3d& at) {
        return evaluator.evaluate(window, at, 0.0, AxisAlignedBox{}).unknown_voxels;
      });
}

Plan planPlainly(KnownMine& mine, const SensorModel& sensor,
                 const std::vector<Eigen::Vector3d>& vertices) {
  return makePlan(
      vertices,
      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return isSweepFreePlainly(mine.tree, a, b, kBox);
      },
      [&](const Eigen::Vector3d& at) { return unknownVoxelsPlainly(mine.tree, sensor, at); });
}

}  // namespace

std::vector<Row> planRows(KnownMine& mine) {
  const SensorModel sensor;
  const map::GainEvaluator evaluator({sensor}, mine.params.resolution_m,
                                     map::GainCounting::kPerRay);
  const double reach = 2.0 * evaluator.reach();
  const AxisAlignedBox region =
      boxAround(mine.middle, {30.0 + reach, 30.0 + reach, 4.0 + 0.27 * reach});
  const map::LocalWindow window(*mine.map.freeze(), region);
  const std::vector<Eigen::Vector3d> vertices =
      sampleVertices(window, map::ConfigurationSpace(kBox, mine.map.freeze()), mine.middle);
  Plan ours;
  Plan plain;
  const double plain_s = secondsOf([&] { plain = planPlainly(mine, sensor, vertices); });
  constexpr int kRounds = 5;
  double ours_s = 0.0;
  for (int round = 0; round < kRounds; ++round)
    ours_s += secondsOf([&] { ours = planOurs(mine, evaluator, region, vertices); });
  bool is_equal = ours.edges == plain.edges && ours.distances == plain.distances;
  const map::TemplateRays rays(sensor, mine.params.resolution_m);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    is_equal = is_equal && ours.unknown_voxels[i] ==
                               unknownInLists(mine.tree, rays, window.indexOf(vertices[i]));
  return {{"one local plan, " + std::to_string(kVertices) + " vertices, " +
               std::to_string(ours.tried_edges) + " edges",
           "the plain ways above", "ms", plain_s * 1e3, ours_s * 1e3 / kRounds, 50.0, is_equal,
           "edges, distances, gains by the same voxel lists"}};
}

}  // namespace spelunk::benchmark
