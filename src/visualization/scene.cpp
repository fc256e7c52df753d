#include "spelunk/visualization/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spelunk/common/contract.h"

namespace spelunk::visualization {

Colour heatColour(double share) {
  const auto t = static_cast<float>(std::isnan(share) ? 0.0 : std::clamp(share, 0.0, 1.0));
  const auto ramp = [](float x) { return std::clamp(x, 0.0F, 1.0F); };
  return {ramp(3.0F * t - 1.0F), ramp(t < 0.5F ? 3.0F * t : 3.0F - 3.0F * t),
          ramp(1.0F - 3.0F * std::max(0.0F, t - 0.1F)), 1.0F};
}

void Scene::add(Element element) {
  if (element.points.empty()) return;
  const auto is_finite = [](const Eigen::Vector3d& point) { return point.allFinite(); };
  if (!std::all_of(element.points.begin(), element.points.end(), is_finite)) return;
  require(element.colours.size() == 1 || element.colours.size() == element.points.size(),
          "Scene::add: one colour, or one a point");
  require(element.shape != Shape::kLineList || element.points.size() % 2 == 0,
          "Scene::add: a line list needs pairs of points");
  elements_.push_back(std::move(element));
}

std::vector<const Element*> Scene::layer(const std::string& name) const {
  std::vector<const Element*> found;
  for (const Element& element : elements_)
    if (element.layer == name) found.push_back(&element);
  return found;
}

Scene withMarksScaled(const Scene& scene, double factor) {
  require(factor > 0.0, "withMarksScaled: factor must be positive");
  Scene scaled;
  for (Element element : scene.elements()) {
    element.size_m *= factor;
    scaled.add(std::move(element));
  }
  return scaled;
}

}  // namespace spelunk::visualization
