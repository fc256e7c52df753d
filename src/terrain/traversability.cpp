#include "spelunk/terrain/traversability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"
#include "window_filters.h"

namespace spelunk::terrain {
namespace {

constexpr int kTile = 16;
constexpr float kReferenceReach_m = 2.0F;  // sums of squares keep their digits so far from it

int cellsOf(double width_m, double cell_m) {
  return std::max(1, static_cast<int>(std::lround(width_m / cell_m)));
}

}  // namespace

std::vector<std::string> TraversabilityParams::problems() const {
  std::vector<std::string> problems;
  if (slope_weight + step_weight + roughness_weight <= 0.0)
    problems.emplace_back("terrain.slope_weight, step_weight and roughness_weight are all 0");
  if (drop_margin_m >= step_limit_m)
    problems.emplace_back("terrain.drop_margin_m must be less than terrain.step_limit_m");
  return problems;
}

int Traversability::marginOf(const TraversabilityParams& params, double cell_m) {
  return std::max(cellsOf(params.slope_window_m, cell_m),
                  cellsOf(params.step_window_m, cell_m) + cellsOf(params.drop_window_m, cell_m));
}

Traversability::Traversability(const TraversabilityParams& params, const WindowGrid& grid)
    : params_(params),
      cell_m_(static_cast<float>(grid.cell())),
      side_(grid.side()),
      plane_cells_(cellsOf(params.slope_window_m, grid.cell())),
      step_cells_(cellsOf(params.step_window_m, grid.cell())),
      drop_cells_(cellsOf(params.drop_window_m, grid.cell())),
      margin_(marginOf(params, grid.cell())) {
  require(side_ > 2 * margin_, "Traversability: the window is smaller than its margins");
  const std::size_t slots = grid.slots();
  layers_.slope.resize(slots);
  layers_.step_m.resize(slots);
  layers_.roughness_m.resize(slots);
  layers_.value.assign(slots, std::numeric_limits<float>::quiet_NaN());
  layers_.ground_class.assign(slots, GroundClass::kUnknown);
  const std::size_t cells = static_cast<std::size_t>(side_) * side_;
  for (auto* layer : {&known_, &height_, &low_, &high_, &bound_, &slope_, &roughness_, &lowest_,
                      &highest_, &fall_, &floor_, &scratch_})
    layer->resize(cells);
  for (auto& sums : row_sums_) sums.resize(cells);
}

void Traversability::update(const ElevationMap& elevation) {
  const CellIndex first = elevation.grid().first();
  const auto foot_z = static_cast<float>(elevation.footHeight());
  const bool is_far = std::fabs(foot_z - reference_z_) > kReferenceReach_m;
  if (is_fresh_ || is_far || elevation.changedEverywhere()) return updateAll(elevation);
  unwrap(elevation);
  marked_.assign(marked_.size(), 0);
  markEntered(first - last_first_);
  markAround(elevation.changed(), first);
  last_first_ = first;
  computeMarked(elevation.grid());
}

void Traversability::updateAll(const ElevationMap& elevation) {
  const auto foot_z = static_cast<float>(elevation.footHeight());
  if (is_fresh_ || std::fabs(foot_z - reference_z_) > kReferenceReach_m) reference_z_ = foot_z;
  is_fresh_ = false;
  last_first_ = elevation.grid().first();
  unwrap(elevation);
  markAll();
  computeMarked(elevation.grid());
}

void Traversability::unwrap(const ElevationMap& elevation) {
  const WindowGrid& grid = elevation.grid();
  const std::vector<float>& heights = elevation.heights();
  const std::vector<float>& bounds = elevation.rayBounds();
  std::size_t cell = 0;
  for (int y = 0; y < side_; ++y)
    for (int x = 0; x < side_; ++x, ++cell) {
      const std::size_t slot = grid.slotOf(grid.first().x() + x, grid.first().y() + y);
      const float height = heights[slot] - reference_z_;
      const bool is_known = !std::isnan(height);
      known_[cell] = is_known ? 1.0F : 0.0F;
      height_[cell] = is_known ? height : 0.0F;
      low_[cell] = is_known ? height : kVeryHigh;
      high_[cell] = is_known ? height : -kVeryHigh;
      bound_[cell] = bounds[slot] - reference_z_;
    }
}

void Traversability::markAll() {
  const int tiles = (side_ + kTile - 1) / kTile;
  marked_.assign(static_cast<std::size_t>(tiles) * tiles, 1);
}

void Traversability::markEntered(const CellIndex& shift) {
  if (shift.cwiseAbs().maxCoeff() >= side_) return markAll();
  const int tiles = (side_ + kTile - 1) / kTile;
  const auto hasEntered = [&](int tile, int moved) {
    const int begin = tile * kTile;
    const int end = begin + kTile;
    if (moved > 0) return end > side_ - margin_ - moved;
    return moved < 0 && begin < margin_ - moved;
  };
  for (int y = 0; y < tiles; ++y)
    for (int x = 0; x < tiles; ++x)
      if (hasEntered(x, shift.x()) || hasEntered(y, shift.y()))
        marked_[static_cast<std::size_t>(y * tiles + x)] = 1;
}

void Traversability::markAround(const std::vector<CellIndex>& cells, const CellIndex& first) {
  struct Extent {
    CellIndex min = CellIndex::Constant(1 << 20);
    CellIndex max = CellIndex::Constant(-(1 << 20));
  };
  const int tiles = (side_ + kTile - 1) / kTile;
  std::vector<Extent> extents(static_cast<std::size_t>(tiles) * tiles);
  for (const CellIndex& cell : cells) {
    const CellIndex at = cell - first;
    Extent& extent = extents[static_cast<std::size_t>(at.y() / kTile * tiles + at.x() / kTile)];
    extent.min = extent.min.cwiseMin(at);
    extent.max = extent.max.cwiseMax(at);
  }
  for (const Extent& extent : extents) {
    if (extent.min.x() > extent.max.x()) continue;
    const CellIndex low = (extent.min.array() - margin_).cwiseMax(0) / kTile;
    const CellIndex high = (extent.max.array() + margin_).cwiseMin(side_ - 1) / kTile;
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x)
        marked_[static_cast<std::size_t>(y * tiles + x)] = 1;
  }
}

void Traversability::computeMarked(const WindowGrid& grid) {
  const int tiles = (side_ + kTile - 1) / kTile;
  const auto clamped = [&](int cell) { return std::clamp(cell, margin_, side_ - margin_); };
  for (int y = 0; y < tiles; ++y)
    for (int x = 0; x < tiles; ++x) {
      const int begin = x;
      while (x < tiles && marked_[static_cast<std::size_t>(y * tiles + x)] != 0) ++x;
      const CellRect rect{clamped(begin * kTile), clamped(y * kTile), clamped(x * kTile),
                          clamped((y + 1) * kTile)};
      if (rect.x_begin >= rect.x_end || rect.y_begin >= rect.y_end) continue;
      fitPlanes(rect);
      measureExtremes(rect);
      store(rect, grid);
      findDrops(rect, grid);
    }
}

void Traversability::measureExtremes(const CellRect& rect) {
  const CellRect around = rect.grown(drop_cells_);
  slidingMin(low_, side_, around, step_cells_, scratch_, lowest_);
  slidingMax(high_, side_, around, step_cells_, scratch_, highest_);
}

void Traversability::store(const CellRect& rect, const WindowGrid& grid) {
  const auto slope_limit = static_cast<float>(std::tan(params_.slope_limit_deg * M_PI / 180.0));
  const auto step_limit = static_cast<float>(params_.step_limit_m);
  const auto roughness_limit = static_cast<float>(params_.roughness_limit_m);
  const double weights = params_.slope_weight + params_.step_weight + params_.roughness_weight;
  const auto slope_weight = static_cast<float>(params_.slope_weight / weights);
  const auto step_weight = static_cast<float>(params_.step_weight / weights);
  const auto roughness_weight = static_cast<float>(params_.roughness_weight / weights);
  const auto value_min = static_cast<float>(params_.value_min);
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const auto cell = static_cast<std::size_t>(y * side_ + x);
      const std::size_t slot = grid.slotOf(grid.first().x() + x, grid.first().y() + y);
      layers_.ground_class[slot] = GroundClass::kUnknown;
      layers_.value[slot] = std::numeric_limits<float>::quiet_NaN();
      if (known_[cell] == 0.0F || slope_[cell] < 0.0F) continue;
      layers_.slope[slot] = slope_[cell];
      layers_.step_m[slot] = highest_[cell] - lowest_[cell];
      layers_.roughness_m[slot] = roughness_[cell];
      const float slope = slope_[cell] / slope_limit;
      const float step = (highest_[cell] - lowest_[cell]) / step_limit;
      const float roughness = roughness_[cell] / roughness_limit;
      const float worst = std::max({slope, step, roughness});
      const float value =
          1.0F - slope_weight * slope - step_weight * step - roughness_weight * roughness;
      const bool is_good = worst <= 1.0F && value >= value_min;
      layers_.value[slot] = worst <= 1.0F ? std::max(0.0F, value) : 0.0F;
      layers_.ground_class[slot] = is_good          ? GroundClass::kTraversable
                                   : slope == worst ? GroundClass::kTooSteep
                                   : step == worst  ? GroundClass::kStep
                                                    : GroundClass::kTooRough;
    }
}

void Traversability::findDrops(const CellRect& rect, const WindowGrid& grid) {
  const auto margin = static_cast<float>(params_.drop_margin_m);
  const auto step_limit = static_cast<float>(params_.step_limit_m);
  const auto fall = static_cast<float>(std::tan(params_.drop_slope_deg * M_PI / 180.0));
  // The parabola whose fall plus the margin is nowhere less than the straight slope's.
  const float curvature = fall * fall / (4.0F * margin) * cell_m_ * cell_m_;
  if (!anyBelow(bound_, known_, lowest_, side_, rect, drop_cells_, margin)) return;
  const CellRect around = rect.grown(drop_cells_);
  for (int y = around.y_begin; y < around.y_end; ++y)
    for (int x = around.x_begin; x < around.x_end; ++x) {
      const auto cell = static_cast<std::size_t>(y * side_ + x);
      if (known_[cell] != 0.0F) continue;
      lowest_[cell] = -kVeryHigh;
      highest_[cell] = kVeryHigh;
    }
  slidingParabola(lowest_, side_, rect, drop_cells_, curvature, scratch_, fall_);
  slidingMin(highest_, side_, rect, drop_cells_, scratch_, floor_);
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
