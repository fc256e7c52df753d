#include <algorithm>
#include <utility>

#include "spelunk/visualization/draw.h"

namespace spelunk::visualization {
namespace {

using planners::GraphLayer;
using planners::GraphVertex;

struct LayerLook {
  Colour edges;
  double line_m;
  double vertex_m;
};

LayerLook lookOf(const std::string& layer) {
  if (layer == "reachability") return {{0.85F, 0.85F, 0.85F, 0.6F}, 0.04, 0.45};
  if (layer == "samples") return {{0.9F, 0.9F, 0.9F, 0.3F}, 0.02, 0.35};
  if (layer == "global") return {{0.95F, 0.75F, 0.2F, 0.35F}, 0.03, 0.3};
  return {{0.35F, 0.6F, 0.9F, 0.25F}, 0.02, 0.18};
}

void drawEdges(const GraphLayer& layer, const LayerLook& look, Scene& scene) {
  Element edges;
  edges.layer = "graph/" + layer.name;
  edges.shape = Shape::kLineList;
  edges.size_m = look.line_m;
  edges.colours = {look.edges};
  for (const auto& [from, to] : layer.edges) {
    if (from >= layer.vertices.size() || to >= layer.vertices.size()) continue;
    edges.points.push_back(layer.vertices[from].position);
    edges.points.push_back(layer.vertices[to].position);
  }
  scene.add(std::move(edges));
}

void drawGains(const GraphLayer& layer, const LayerLook& look, Scene& scene) {
  double most = 0.0;
  for (const GraphVertex& vertex : layer.vertices) most = std::max(most, vertex.gain_m3);
  Element gains;
  gains.layer = "gain/" + layer.name;
  gains.shape = Shape::kSpheres;
  gains.size_m = look.vertex_m;
  for (const GraphVertex& vertex : layer.vertices) {
    if (vertex.gain_m3 <= 0.0) continue;
    gains.points.push_back(vertex.position);
    gains.colours.push_back(heatColour(vertex.gain_m3 / most));
  }
  scene.add(std::move(gains));
}

/// The reachability graph of Akbari 2021, Fig. 5: red is to be explored, green is done.
void drawExploration(const GraphLayer& layer, Scene& scene) {
  Element vertices;
  vertices.layer = "explored/" + layer.name;
  vertices.shape = Shape::kSpheres;
  vertices.size_m = 0.45;
  for (const GraphVertex& vertex : layer.vertices) {
    vertices.points.push_back(vertex.position);
    vertices.colours.push_back(vertex.is_frontier ? Colour{0.9F, 0.15F, 0.1F, 0.9F}
                                                  : Colour{0.2F, 0.75F, 0.25F, 0.9F});
  }
  scene.add(std::move(vertices));
}

void drawFrontiers(const GraphLayer& layer, Scene& scene) {
  Element frontiers;
  frontiers.layer = "frontier/" + layer.name;
  frontiers.shape = Shape::kSpheres;
  frontiers.size_m = 0.6;
  frontiers.colours = {{1.0F, 0.2F, 0.75F, 0.9F}};
  for (const GraphVertex& vertex : layer.vertices)
    if (vertex.is_frontier) frontiers.points.push_back(vertex.position);
  scene.add(std::move(frontiers));
}

}  // namespace

void drawGraph(const planners::PlannerGraph& graph, Scene& scene) {
  for (const GraphLayer& layer : graph.layers) {
    const LayerLook look = lookOf(layer.name);
    drawEdges(layer, look, scene);
    drawGains(layer, look, scene);
    if (layer.name == "reachability")
      drawExploration(layer, scene);
    else
      drawFrontiers(layer, scene);
  }
}

}  // namespace spelunk::visualization
