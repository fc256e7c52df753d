#include "scan_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace spelunk::terrain {
namespace {

constexpr std::size_t kBlock = 256;
constexpr float kTopBand_m = 0.1F;   // noise and slope within a cell, less than a step
constexpr float kFarthest_m = 1e5F;  // farther coordinates are no returns
constexpr float kInf = std::numeric_limits<float>::infinity();

}  // namespace

const ScanCells::Stack ScanCells::kEmpty{kInf, -kInf, 0.0F, 0};

ScanCells::ScanCells(const ElevationParams& params, const WindowGrid& grid)
    : side_(grid.side()),
      cell_m_(static_cast<float>(params.cell_m)),
      clearance_m_(static_cast<float>(params.clearance_m)),
      climb_(static_cast<float>(std::tan(params.climb_deg * M_PI / 180.0))),
      half_body_m_(0.5F * params.body_m.cast<float>()),
      open_(kEmpty),
      stacks_(static_cast<std::size_t>(side_) * side_, kEmpty),
      rays_(params.cell_m, 1.7 * params.reach_m) {}

/// Points of a block in the window's frame.
struct ScanCells::Block {
  std::array<float, kBlock> x;
  std::array<float, kBlock> y;
  std::array<float, kBlock> z;
  std::array<std::int32_t, kBlock> cell;
  std::array<std::int32_t, kBlock> is_plain;  ///< In the window, not high, not near the body.
};

/// Coordinate by coordinate and without branches, for the vectoriser.
void ScanCells::fill(const float* __restrict points, std::size_t count, const WindowFrame& frame,
                     Block& __restrict block) const {
  const Eigen::Matrix3f r = frame.R_window_sensor;
  const Eigen::Vector3f t = frame.sensor;
  const Eigen::Vector3f base = frame.base;
  const float high = frame.foot_z + clearance_m_;
  const float climb = climb_;
  const float extent = static_cast<float>(side_) * cell_m_;
  const float per_cell = 1.0F / cell_m_;
  const int side = side_;
  const float body_radius = half_body_m_.norm();
  for (std::size_t i = 0; i < count; ++i) {
    const float px = points[3 * i];
    const float py = points[3 * i + 1];
    const float pz = points[3 * i + 2];
    const float x = r(0, 0) * px + r(0, 1) * py + r(0, 2) * pz + t.x();
    const float y = r(1, 0) * px + r(1, 1) * py + r(1, 2) * pz + t.y();
    const float z = r(2, 0) * px + r(2, 1) * py + r(2, 2) * pz + t.z();
    const float dx = x - base.x();
    const float dy = y - base.y();
    const float distance = std::sqrt(dx * dx + dy * dy);
    const bool is_plain = (x >= 0.0F) & (x < extent) & (y >= 0.0F) & (y < extent) &
                          (z > -kFarthest_m) & (z <= high + climb * distance) &
                          (distance >= body_radius);
    const int column = std::min(static_cast<int>(is_plain ? x * per_cell : 0.0F), side - 1);
    const int row = std::min(static_cast<int>(is_plain ? y * per_cell : 0.0F), side - 1);
    block.x[i] = x;
    block.y[i] = y;
    block.z[i] = z;
    block.cell[i] = row * side + column;
    block.is_plain[i] = is_plain ? 1 : 0;
  }
}

void ScanCells::collect(const std::vector<Eigen::Vector3f>& points, const WindowFrame& frame,
                        const WindowGrid& grid, const std::vector<float>& heights,
                        ElevationUpdate& update) {
  if (cells_.size() < points.size()) {
    cells_.resize(points.size());
    heights_.resize(points.size());
  }
  used_ = 0;
  rays_.clear();
  update.points = static_cast<int>(points.size());
  for (std::size_t i = 0; i < points.size(); i += kBlock)
    sortBlock(points.data() + i, std::min(kBlock, points.size() - i), frame, update);
  stacks_[open_cell_] = open_;
  open_ = kEmpty;
  open_cell_ = 0;
  cutTallStacks(update);
  measure(frame, grid, heights, update);
  rays_.finish();
}

void ScanCells::sortBlock(const Eigen::Vector3f* points, std::size_t count,
                          const WindowFrame& frame, ElevationUpdate& update) {
  Block block;
  fill(points->data(), count, frame, block);
  for (std::size_t i = 0; i < count; ++i) {
    if (block.is_plain[i] != 0)
      place(static_cast<std::uint32_t>(block.cell[i]), block.z[i]);
    else
      placeOdd({block.x[i], block.y[i], block.z[i]}, frame, update);
  }
}

void ScanCells::place(std::uint32_t cell, float z) {
  cells_[used_] = cell;
  heights_[used_] = z;
  ++used_;
  if (cell != open_cell_) openStack(cell);
  open_.lowest = std::min(open_.lowest, z);
  open_.highest = std::max(open_.highest, z);
  open_.sum += z;
  ++open_.count;
}

void ScanCells::openStack(std::uint32_t cell) {
  stacks_[open_cell_] = open_;
  open_cell_ = cell;
  open_ = stacks_[cell];
  if (open_.count == 0) touched_.push_back(cell);
}

void ScanCells::placeOdd(const Eigen::Vector3f& point, const WindowFrame& frame,
                         ElevationUpdate& update) {
  const float extent = static_cast<float>(side_) * cell_m_;
  if (!(point.cwiseAbs().maxCoeff() < kFarthest_m) || !point.allFinite()) {
    ++update.dropped_not_finite;
    return;
  }
  if (!((point.head<2>().array() >= 0.0F).all() && (point.head<2>().array() < extent).all())) {
    ++update.dropped_outside;
    rays_.add(point - frame.sensor);
    return;
  }
  if (((frame.T_base_window * point).array().abs() <= half_body_m_.array()).all()) {
    ++update.dropped_self;
    return;
  }
  const float distance = (point - frame.base).head<2>().norm();
  if (point.z() > frame.foot_z + clearance_m_ + climb_ * distance) {
    ++update.dropped_high;
    return;
  }
  const int column = std::min(static_cast<int>(point.x() / cell_m_), side_ - 1);
  const int row = std::min(static_cast<int>(point.y() / cell_m_), side_ - 1);
  place(static_cast<std::uint32_t>(row * side_ + column), point.z());
}

void ScanCells::cutTallStacks(ElevationUpdate& update) {
  bool is_any_tall = false;
  const auto isTall = [](const Stack& stack) { return stack.highest - stack.lowest > kTopBand_m; };
  for (const std::uint32_t cell : touched_) {
    Stack& stack = stacks_[cell];
    if (!isTall(stack)) continue;
    is_any_tall = true;
    stack.count = 0;  // marks it
    stack.sum = 0.0F;
    stack.highest = -kInf;
  }
  if (!is_any_tall) return;
  for (std::size_t i = 0; i < used_; ++i) {
    Stack& stack = stacks_[cells_[i]];
    if (stack.count == 0 && heights_[i] <= stack.lowest + clearance_m_)
      stack.highest = std::max(stack.highest, heights_[i]);
  }
  for (std::size_t i = 0; i < used_; ++i) {
    Stack& stack = stacks_[cells_[i]];
    if (stack.count > 0) continue;
    if (heights_[i] > stack.highest) {
      ++update.dropped_high;
    } else if (heights_[i] >= stack.highest - kTopBand_m) {
      stack.sum += heights_[i];
      --stack.count;  // negative: still marked
    }
  }
}

void ScanCells::measure(const WindowFrame& frame, const WindowGrid& grid,
                        const std::vector<float>& heights, ElevationUpdate& update) {
  measures_.clear();
  for (const std::uint32_t cell : touched_) {
    Stack& stack = stacks_[cell];
    const int x = static_cast<int>(cell) % side_;
    const int y = static_cast<int>(cell) / side_;
    const int count = std::abs(stack.count);
    const float known = heights[grid.slotOf(grid.first().x() + x, grid.first().y() + y)];
    rays_.add(Eigen::Vector3f((static_cast<float>(x) + 0.5F) * cell_m_,
                              (static_cast<float>(y) + 0.5F) * cell_m_, stack.lowest) -
              frame.sensor);
    if (stack.lowest > known + clearance_m_)
      update.dropped_high += count;
    else
      measures_.push_back({x, y, stack.lowest, stack.sum / static_cast<float>(count), count});
    stack = kEmpty;
  }
  touched_.clear();
}

}  // namespace spelunk::terrain
