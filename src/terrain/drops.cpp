#include <algorithm>
#include <cmath>

#include "spelunk/terrain/traversability.h"
#include "window_filters.h"

namespace spelunk::terrain {

void Traversability::forgetUnknown(const CellRect& rect, const WindowGrid& grid) {
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      if (known_[static_cast<std::size_t>(y * side_ + x)] != 0.0F) continue;
      const std::size_t slot = grid.slotOf(grid.first().x() + x, grid.first().y() + y);
      layers_.ground_class[slot] = GroundClass::kUnknown;
      layers_.value[slot] = kNoValue;
    }
}

void Traversability::findDrops(const CellRect& rect, const WindowGrid& grid) {
  forgetUnknown(rect, grid);
  const auto margin = static_cast<float>(params_.drop_margin_m);
  for (int y = rect.y_begin; y < rect.y_end; y += kTile)
    for (int x = rect.x_begin; x < rect.x_end; x += kTile) {
      const CellRect tile{x, y, std::min(x + kTile, rect.x_end), std::min(y + kTile, rect.y_end)};
      if (anyBelow(bound_, known_, upper_, side_, tile, drop_cells_, margin))
        judgeUnknown(tile, grid);
    }
}

void Traversability::judgeUnknown(const CellRect& rect, const WindowGrid& grid) {
  const auto margin = static_cast<float>(params_.drop_margin_m);
  const auto step_limit = static_cast<float>(params_.step_limit_m);
  const auto fall = static_cast<float>(std::tan(params_.drop_slope_deg * M_PI / 180.0));
  // The parabola whose fall plus the margin is nowhere less than the straight slope's.
  const float curvature = fall * fall / (4.0F * margin) * cell_m_ * cell_m_;
  slidingParabola(upper_, side_, rect, drop_cells_, curvature, scratch_, fall_);
  slidingMin(lower_, side_, rect, drop_cells_, scratch_, floor_);
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const auto cell = static_cast<std::size_t>(y * side_ + x);
      const float bound = bound_[cell];
      if (known_[cell] != 0.0F || bound >= fall_[cell] - margin) continue;
      if (bound >= floor_[cell] - margin && bound >= fall_[cell] - step_limit) continue;
      const std::size_t slot = grid.slotOf(grid.first().x() + x, grid.first().y() + y);
      layers_.ground_class[slot] = GroundClass::kDrop;
      layers_.value[slot] = 0.0F;
    }
}

}  // namespace spelunk::terrain
