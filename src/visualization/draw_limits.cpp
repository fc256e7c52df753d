#include <algorithm>
#include <array>
#include <cmath>

#include "spelunk/visualization/draw.h"

namespace spelunk::visualization {
namespace {

/// The open sides of `box` closed by those of `shown`.
AxisAlignedBox closedBy(const AxisAlignedBox& shown, const AxisAlignedBox& box) {
  AxisAlignedBox closed = box;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min[axis])) closed.min[axis] = std::min(shown.min[axis], box.max[axis]);
    if (!std::isfinite(box.max[axis])) closed.max[axis] = std::max(shown.max[axis], box.min[axis]);
  }
  return closed;
}

Element linesOf(const std::string& layer, Colour colour) {
  Element lines;
  lines.layer = layer;
  lines.shape = Shape::kLineList;
  lines.size_m = 0.06;
  lines.colours = {colour};
  return lines;
}

void addLine(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Element& lines) {
  lines.points.push_back(from);
  lines.points.push_back(to);
}

constexpr Colour kBoundsColour{0.4F, 0.9F, 0.9F, 0.6F};
constexpr Colour kZoneColour{1.0F, 0.15F, 0.15F, 0.9F};

}  // namespace

void drawBounds(const AxisAlignedBox& bounds, const AxisAlignedBox& shown, Scene& scene) {
  if (!bounds.min.array().isFinite().any() && !bounds.max.array().isFinite().any()) return;
  const AxisAlignedBox box = closedBy(shown, bounds);
  Element lines = linesOf("bounds", kBoundsColour);
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner & (1 << axis)) continue;
      Eigen::Vector3d from;
      for (int i = 0; i < 3; ++i) from[i] = (corner & (1 << i)) ? box.max[i] : box.min[i];
      Eigen::Vector3d to = from;
      to[axis] = box.max[axis];
      addLine(from, to, lines);
    }
  }
  scene.add(std::move(lines));
}

void drawZones(const std::vector<NoGoZone>& zones, const AxisAlignedBox& shown, Scene& scene) {
  for (const NoGoZone& zone : zones) {
    const double low = std::isfinite(zone.z_min) ? zone.z_min : std::min(shown.min.z(), zone.z_max);
    const double high = std::isfinite(zone.z_max) ? zone.z_max : std::max(shown.max.z(), low);
    Element lines = linesOf("no_go_zones", kZoneColour);
    Element name = linesOf("no_go_zones", kZoneColour);
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    const std::size_t corners = zone.polygon.size();
    for (std::size_t i = 0; i < corners; ++i) {
      const Eigen::Vector2d& a = zone.polygon[i];
      const Eigen::Vector2d& b = zone.polygon[(i + 1) % corners];
      addLine({a.x(), a.y(), low}, {b.x(), b.y(), low}, lines);
      addLine({a.x(), a.y(), high}, {b.x(), b.y(), high}, lines);
      addLine({a.x(), a.y(), low}, {a.x(), a.y(), high}, lines);
      middle += a / static_cast<double>(corners);
    }
    scene.add(std::move(lines));
    name.shape = Shape::kText;
    name.text = zone.name;
    name.size_m = 0.8;
    name.points = {{middle.x(), middle.y(), high + 0.5}};
    if (!zone.name.empty() && corners > 0) scene.add(std::move(name));
  }
}

}  // namespace spelunk::visualization
