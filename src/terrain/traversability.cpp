#include "spelunk/terrain/traversability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/contract.h"
#include "window_filters.h"

namespace spelunk::terrain {
namespace {

constexpr float kReferenceReach_m = 2.0F;  // sums of squares keep their digits so far from it

int tilesOf(int side) { return (side + kTile - 1) / kTile; }

int cellsOf(double width_m, double cell_m) {
  return std::max(1, static_cast<int>(std::lround(width_m / cell_m)));
}

/// Limits and weights as the loop over cells wants them.
class Rating {
 public:
  explicit Rating(const TraversabilityParams& params)
      : slope_limit_(static_cast<float>(std::tan(params.slope_limit_deg * M_PI / 180.0))),
        step_limit_(static_cast<float>(params.step_limit_m)),
        roughness_limit_(static_cast<float>(params.roughness_limit_m)),
        value_min_(static_cast<float>(params.value_min)) {
    const double sum = params.slope_weight + params.step_weight + params.roughness_weight;
    slope_weight_ = static_cast<float>(params.slope_weight / sum);
    step_weight_ = static_cast<float>(params.step_weight / sum);
    roughness_weight_ = static_cast<float>(params.roughness_weight / sum);
  }

  struct Result {
    float value;
    GroundClass ground_class;
  };
  /// Of a known cell; a negative slope stands for none.
  [[nodiscard]] Result of(float slope_tangent, float step_m, float roughness_m) const {
    if (slope_tangent < 0.0F) return {kNoValue, GroundClass::kUnknown};
    const float slope = slope_tangent / slope_limit_;
    const float step = step_m / step_limit_;
    const float roughness = roughness_m / roughness_limit_;
    const float worst = std::max({slope, step, roughness});
    const float loss = slope_weight_ * slope + step_weight_ * step + roughness_weight_ * roughness;
    const float value = worst <= 1.0F ? std::max(0.0F, 1.0F - loss) : 0.0F;
    if (worst <= 1.0F && value >= value_min_) return {value, GroundClass::kTraversable};
    if (slope == worst) return {value, GroundClass::kTooSteep};
    return {value, step == worst ? GroundClass::kStep : GroundClass::kTooRough};
  }

 private:
  float slope_limit_;
  float step_limit_;
  float roughness_limit_;
  float value_min_;
  float slope_weight_;
  float step_weight_;
  float roughness_weight_;
};

}  // namespace

const char* toText(GroundClass ground) {
  switch (ground) {
    case GroundClass::kUnknown:
      return "not seen";
    case GroundClass::kTraversable:
      return "traversable";
    case GroundClass::kTooSteep:
      return "too steep";
    case GroundClass::kStep:
      return "a step";
    case GroundClass::kTooRough:
      return "too rough";
    case GroundClass::kDrop:
      return "a drop";
  }
  return "";
}

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
  layers_.value.assign(slots, kNoValue);
  layers_.ground_class.assign(slots, GroundClass::kUnknown);
  const std::size_t cells = static_cast<std::size_t>(side_) * side_ + kLanes;
  for (auto* layer : {&known_, &height_, &low_, &high_, &bound_, &slope_, &roughness_, &lowest_,
                      &highest_, &upper_, &lower_, &fall_, &floor_, &scratch_})
    layer->resize(cells);
  for (auto& sums : row_sums_) sums.resize(cells);
}

void Traversability::note(const ElevationMap& elevation) {
  const std::vector<CellIndex>& changed = elevation.changed();
  // Nobody asked for long: rather all again than a list without end.
  if (noted_.size() > 4 * known_.size()) is_fresh_ = true;
  if (is_fresh_) noted_.clear();
  if (is_fresh_) return;
  noted_.insert(noted_.end(), changed.begin(), changed.end());
  noted_everywhere_ = noted_everywhere_ || elevation.changedEverywhere();
}

void Traversability::update(const ElevationMap& elevation) {
  const auto foot_z = static_cast<float>(elevation.footHeight());
  if (is_fresh_ || std::fabs(foot_z - reference_z_) > kReferenceReach_m)
    return updateAll(elevation);
  unwrap(elevation);
  const WindowGrid& grid = elevation.grid();
  const int tiles = tilesOf(side_);
  Marks shapes(static_cast<std::size_t>(tiles) * tiles, 0);
  Marks drops(shapes.size(), noted_everywhere_ ? 1 : 0);
  markEntered(grid.first() - last_first_, shapes);
  markEntered(grid.first() - last_first_, drops);
  markAround(grid.first(), std::max(plane_cells_, step_cells_), shapes);
  markAround(grid.first(), margin_, drops);
  for (const CellRect& rect : rectsOf(shapes)) computeShapes(rect, grid);
  for (const CellRect& rect : rectsOf(drops)) findDrops(rect, grid);
  last_first_ = grid.first();
  noted_.clear();
  noted_everywhere_ = false;
}

void Traversability::updateAll(const ElevationMap& elevation) {
  const auto foot_z = static_cast<float>(elevation.footHeight());
  if (is_fresh_ || std::fabs(foot_z - reference_z_) > kReferenceReach_m) reference_z_ = foot_z;
  is_fresh_ = false;
  unwrap(elevation);
  const int end = side_ - margin_;
  const CellRect everything{margin_, margin_, end, end};
  computeShapes(everything, elevation.grid());
  findDrops(everything, elevation.grid());
  last_first_ = elevation.grid().first();
  noted_.clear();
  noted_everywhere_ = false;
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
  const CellRect inner = CellRect{0, 0, side_, side_}.grown(-step_cells_);
  slidingMin(low_, side_, inner, step_cells_, scratch_, lowest_);
  slidingMax(high_, side_, inner, step_cells_, scratch_, highest_);
  for (cell = 0; cell < lowest_.size(); ++cell) {
    upper_[cell] = known_[cell] != 0.0F ? lowest_[cell] : -kVeryHigh;
    lower_[cell] = known_[cell] != 0.0F ? highest_[cell] : kVeryHigh;
  }
}

void Traversability::markEntered(const CellIndex& shift, Marks& marks) const {
  const int tiles = tilesOf(side_);
  const auto hasEntered = [&](int tile, int moved) {
    const int begin = tile * kTile;
    if (moved > 0) return begin + kTile > side_ - margin_ - moved;
    return moved < 0 && begin < margin_ - moved;
  };
  for (int y = 0; y < tiles; ++y)
    for (int x = 0; x < tiles; ++x)
      if (hasEntered(x, shift.x()) || hasEntered(y, shift.y()))
        marks[static_cast<std::size_t>(y * tiles + x)] = 1;
}

void Traversability::markAround(const CellIndex& first, int reach, Marks& marks) const {
  struct Extent {
    CellIndex min = CellIndex::Constant(1 << 20);
    CellIndex max = CellIndex::Constant(-(1 << 20));
  };
  const int tiles = tilesOf(side_);
  std::vector<Extent> extents(marks.size());
  for (const CellIndex& cell : noted_) {
    const CellIndex at = cell - first;
    if ((at.array() < 0).any() || (at.array() >= side_).any()) continue;
    Extent& extent = extents[static_cast<std::size_t>(at.y() / kTile * tiles + at.x() / kTile)];
    extent.min = extent.min.cwiseMin(at);
    extent.max = extent.max.cwiseMax(at);
  }
  for (const Extent& extent : extents) {
    if (extent.min.x() > extent.max.x()) continue;
    const CellIndex low = (extent.min.array() - reach).cwiseMax(0) / kTile;
    const CellIndex high = (extent.max.array() + reach).cwiseMin(side_ - 1) / kTile;
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) marks[static_cast<std::size_t>(y * tiles + x)] = 1;
  }
}

std::vector<CellRect> Traversability::rectsOf(const Marks& marks) const {
  const int tiles = tilesOf(side_);
  const auto clamped = [&](int cell) { return std::clamp(cell, margin_, side_ - margin_); };
  const auto marked = std::count(marks.begin(), marks.end(), 1);
  if (static_cast<std::size_t>(2 * marked) > marks.size())
    return {{margin_, margin_, side_ - margin_, side_ - margin_}};
  std::vector<CellRect> rects;
  for (int y = 0; y < tiles; ++y)
    for (int x = 0; x < tiles; ++x) {
      const int begin = x;
      while (x < tiles && marks[static_cast<std::size_t>(y * tiles + x)] != 0) ++x;
      const CellRect rect{clamped(begin * kTile), clamped(y * kTile), clamped(x * kTile),
                          clamped((y + 1) * kTile)};
      if (rect.x_begin < rect.x_end && rect.y_begin < rect.y_end) rects.push_back(rect);
    }
  return rects;
}

void Traversability::computeShapes(const CellRect& rect, const WindowGrid& grid) {
  fitPlanes(rect);
  rate(rect, grid);
}

void Traversability::rate(const CellRect& rect, const WindowGrid& grid) {
  const Rating rating(params_);
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const auto cell = static_cast<std::size_t>(y * side_ + x);
      if (known_[cell] == 0.0F) continue;  // for findDrops
      const std::size_t slot = grid.slotOf(grid.first().x() + x, grid.first().y() + y);
      const float step = highest_[cell] - lowest_[cell];
      layers_.slope[slot] = slope_[cell];
      layers_.step_m[slot] = step;
      layers_.roughness_m[slot] = roughness_[cell];
      const Rating::Result result = rating.of(slope_[cell], step, roughness_[cell]);
      layers_.value[slot] = result.value;
      layers_.ground_class[slot] = result.ground_class;
    }
}

}  // namespace spelunk::terrain
