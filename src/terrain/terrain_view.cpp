#include "spelunk/terrain/terrain_view.h"

#include <cmath>

namespace spelunk::terrain {

TerrainView::TerrainView(const ElevationMap& elevation, const Traversability& traversability)
    : grid_(elevation.grid()),
      margin_(traversability.margin()),
      heights_(elevation.heights()),
      variances_(elevation.variances()),
      bounds_(elevation.rayBounds()),
      values_(traversability.layers().value),
      classes_(traversability.layers().ground_class) {}

bool TerrainView::covers(const CellIndex& cell) const {
  const int inner = grid_.side() - 2 * margin_;
  const CellIndex at = cell - grid_.first() - CellIndex::Constant(margin_);
  return (at.array() >= 0).all() && (at.array() < inner).all();
}

GroundClass TerrainView::classAt(const CellIndex& cell) const {
  return covers(cell) ? classes_[grid_.slotOf(cell)] : GroundClass::kUnknown;
}

std::optional<double> TerrainView::valueAt(const CellIndex& cell) const {
  if (classAt(cell) == GroundClass::kUnknown) return std::nullopt;
  return values_[grid_.slotOf(cell)];
}

std::optional<double> TerrainView::groundHeight(const Eigen::Vector2d& xy) const {
  return groundHeight(grid_.cellOf(xy));
}

std::optional<double> TerrainView::groundHeight(const CellIndex& cell) const {
  if (!covers(cell) || std::isnan(heights_[grid_.slotOf(cell)])) return std::nullopt;
  return heights_[grid_.slotOf(cell)];
}

template <class Visit>
void TerrainView::forEachCovered(Visit&& visit) const {
  const CellIndex end = grid_.first().array() + grid_.side() - margin_;
  for (int y = grid_.first().y() + margin_; y < end.y(); ++y)
    for (int x = grid_.first().x() + margin_; x < end.x(); ++x) visit(CellIndex(x, y));
}

std::vector<TerrainPoint> TerrainView::points() const {
  std::vector<TerrainPoint> points;
  forEachCovered([&](const CellIndex& cell) {
    const std::size_t slot = grid_.slotOf(cell);
    const bool is_drop = classes_[slot] == GroundClass::kDrop;
    if (std::isnan(heights_[slot]) && !is_drop) return;
    TerrainPoint point;
    point.position.head<2>() = grid_.centreOf(cell);
    point.position.z() = is_drop ? bounds_[slot] : heights_[slot];
    point.variance_m2 = is_drop ? 0.0F : variances_[slot];
    point.ground_class = classes_[slot];
    if (point.ground_class == GroundClass::kTraversable) point.value = values_[slot];
    points.push_back(point);
  });
  return points;
}

int TerrainView::count(GroundClass ground_class) const {
  int count = 0;
  forEachCovered([&](const CellIndex& cell) {
    count += classes_[grid_.slotOf(cell)] == ground_class ? 1 : 0;
  });
  return count;
}

}  // namespace spelunk::terrain
