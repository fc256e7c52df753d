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
      stacks_(static_cast<std::size_t>(side_) * side_, kEmpty),
      rays_(params.cell_m, 1.7 * params.reach_m) {}

/// Points of a block in the window's frame, coordinate by coordinate for the vectoriser.
struct ScanCells::Block {
  std::array<float, kBlock> x;
  std::array<float, kBlock> y;
  std::array<float, kBlock> z;
  std::array<float, kBlock> distance;  ///< From the base, level.

  Block(const Eigen::Vector3f* points, std::size_t count, const WindowFrame& frame) {
    const Eigen::Matrix3f r = frame.R_window_sensor;
    const Eigen::Vector3f t = frame.sensor;
    const Eigen::Vector3f base = frame.base;
    for (std::size_t i = 0; i < count; ++i) {
      const float px = points[i].x();
      const float py = points[i].y();
      const float pz = points[i].z();
      x[i] = r(0, 0) * px + r(0, 1) * py + r(0, 2) * pz + t.x();
      y[i] = r(1, 0) * px + r(1, 1) * py + r(1, 2) * pz + t.y();
      z[i] = r(2, 0) * px + r(2, 1) * py + r(2, 2) * pz + t.z();
      const float dx = x[i] - base.x();
      const float dy = y[i] - base.y();
      distance[i] = std::sqrt(dx * dx + dy * dy);
    }
  }
};

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
  cutTallStacks(update);
  measure(frame, grid, heights, update);
  rays_.finish();
}

void ScanCells::sortBlock(const Eigen::Vector3f* points, std::size_t count,
                          const WindowFrame& frame, ElevationUpdate& update) {
  const Block block(points, count, frame);
  const float extent = static_cast<float>(side_) * cell_m_;
  const float body_radius = half_body_m_.norm();
  for (std::size_t i = 0; i < count; ++i) {
    const float x = block.x[i];
    const float y = block.y[i];
    const float z = block.z[i];
    if (x >= 0.0F && x < extent && y >= 0.0F && y < extent && std::fabs(z) < kFarthest_m) {
      if (block.distance[i] < body_radius &&
          ((frame.T_base_window * Eigen::Vector3f(x, y, z)).array().abs() <= half_body_m_.array())
              .all())
        ++update.dropped_self;
      else
        place(block, i, frame, update);
    } else if (std::fabs(x) + std::fabs(y) + std::fabs(z) < kFarthest_m) {
      ++update.dropped_outside;
      rays_.add(Eigen::Vector3f(x, y, z) - frame.sensor);
    } else {
      ++update.dropped_not_finite;
    }
  }
}

void ScanCells::place(const Block& block, std::size_t i, const WindowFrame& frame,
                      ElevationUpdate& update) {
  const float z = block.z[i];
  if (z > frame.foot_z + clearance_m_ + climb_ * block.distance[i]) {
    ++update.dropped_high;
    return;
  }
  const float per_cell = 1.0F / cell_m_;
  const int column = std::min(static_cast<int>(block.x[i] * per_cell), side_ - 1);
  const int row = std::min(static_cast<int>(block.y[i] * per_cell), side_ - 1);
  const auto cell = static_cast<std::uint32_t>(row * side_ + column);
  Stack& stack = stacks_[cell];
  if (stack.count == 0) touched_.push_back(cell);
  stack.lowest = std::min(stack.lowest, z);
  stack.highest = std::max(stack.highest, z);
  stack.sum += z;
  ++stack.count;
  cells_[used_] = cell;
  heights_[used_] = z;
  ++used_;
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
