#include "spelunk/planners/gbplanner/presumed_piece.h"

#include "spelunk/graph/shortest_paths.h"

namespace spelunk::planners::gbplanner {
namespace {

using graph::VertexId;

constexpr double kCost = 0.5;  // of a metre flown, in metres nearer

}  // namespace

graph::Polyline pieceTowards(const LocalGraph& local, const map::PresumedWays& to_target,
                             const TriedTargets& tried) {
  const double whole = to_target.distanceTo(local.graph.position(local.root));
  const graph::ShortestPaths ways = graph::shortestPaths(local.graph, local.root);
  std::optional<VertexId> best;
  double best_score = 0.0;
  for (std::size_t i = 0; i < local.graph.vertexCount(); ++i) {
    const VertexId vertex{static_cast<std::uint32_t>(i)};
    const Eigen::Vector3d& at = local.graph.position(vertex);
    const double nearer = whole - to_target.distanceTo(at);
    if (!ways.reaches(vertex) || nearer < kPresumedProgress_m || tried.findRefusal(at)) continue;
    const double score = nearer - kCost * ways.distanceTo(vertex);
    if (score <= best_score) continue;
    best_score = score;
    best = vertex;
  }
  graph::Polyline piece;
  if (!best) return piece;
  for (const VertexId id : ways.pathTo(*best)) piece.push_back(local.graph.position(id));
  return piece;
}

}  // namespace spelunk::planners::gbplanner
