#include <cmath>

#include "spelunk/visualization/draw.h"

namespace spelunk::visualization {
namespace {

void drawLine(const std::string& layer, const Path& path, Colour colour, double width_m,
              Scene& scene) {
  if (path.size() < 2) return;
  Element line;
  line.layer = layer;
  line.shape = Shape::kLineStrip;
  line.size_m = width_m;
  line.colours = {colour};
  for (const Pose& pose : path) line.points.push_back(pose.position);
  scene.add(std::move(line));
}

Colour colourOf(planners::PathKind kind) {
  switch (kind) {
    case planners::PathKind::kLocal:
      return {0.15F, 0.95F, 0.35F, 1.0F};
    case planners::PathKind::kReposition:
      return {1.0F, 0.55F, 0.1F, 1.0F};
    case planners::PathKind::kHome:
      return {0.3F, 0.7F, 1.0F, 1.0F};
  }
  return {};
}

}  // namespace

void drawActivePath(const Path& path, planners::PathKind kind, Scene& scene) {
  if (path.empty()) return;
  drawLine("path", path, colourOf(kind), 0.3, scene);
  Element end;
  end.layer = "path";
  end.shape = Shape::kSpheres;
  end.size_m = 0.7;
  end.colours = {colourOf(kind)};
  end.points = {path.back().position};
  scene.add(std::move(end));
}

void drawWayHome(const Path& path, Scene& scene) {
  drawLine("way_home", path, {0.3F, 0.7F, 1.0F, 0.9F}, 0.16, scene);
}

void drawTrail(const Path& path, Scene& scene) {
  drawLine("trail", path, {0.9F, 0.9F, 0.9F, 0.9F}, 0.1, scene);
}

void drawRobot(const Pose& pose, const Eigen::Vector3d& box_m, Scene& scene) {
  Element body;
  body.layer = "robot";
  body.shape = Shape::kBox;
  body.points = {pose.position};
  body.extents_m = box_m;                       // The planner's box does not turn with the robot.
  body.colours = {{1.0F, 0.85F, 0.2F, 0.25F}};  // The robot's model shows through.
  scene.add(std::move(body));

  Element heading;
  heading.layer = "robot";
  heading.shape = Shape::kLineStrip;
  heading.size_m = 0.12;
  heading.colours = {{0.9F, 0.1F, 0.1F, 1.0F}};
  const Eigen::Vector3d ahead(std::cos(pose.yaw), std::sin(pose.yaw), 0.0);
  heading.points = {pose.position, pose.position + 0.8 * box_m.x() * ahead};
  scene.add(std::move(heading));
}

void drawNavigation(const navigation::NavigationAnswer& answer, Scene& scene) {
  Element trees;
  trees.layer = "navigation/trees";
  trees.shape = Shape::kLineList;
  trees.size_m = 0.02;
  trees.colours = {{0.6F, 0.6F, 0.75F, 0.5F}};
  for (const auto& [from, to] : answer.trees.edges) {
    trees.points.push_back(answer.trees.vertices[from]);
    trees.points.push_back(answer.trees.vertices[to]);
  }
  scene.add(std::move(trees));
  const double length_m = lengthOf(answer.path);
  const auto addPart = [&](const char* layer, double from_m, double to_m, const Colour& colour) {
    if (answer.path.empty() || to_m <= from_m) return;
    Element part;
    part.layer = layer;
    part.shape = Shape::kLineStrip;
    part.size_m = 0.12;
    part.colours = {colour};
    for (const Pose& pose : slice(answer.path, from_m, to_m)) part.points.push_back(pose.position);
    scene.add(std::move(part));
  };
  addPart("navigation/known", 0.0, answer.known_length_m, {0.15F, 0.7F, 0.3F, 1.0F});
  addPart("navigation/unknown", answer.known_length_m, length_m, {0.95F, 0.6F, 0.1F, 1.0F});
}

}  // namespace spelunk::visualization
