#include "scan_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace spelunk::terrain {
namespace {

constexpr std::size_t kBlock = 256;
constexpr float kTopBand_m = 0.1F;   // noise and slope within a cell, less than a step
constexpr int kSectors = 512;        // 5 cm apart at 4 m
constexpr float kFarthest_m = 1e5F;  // farther coordinates are no returns
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Grows with the azimuth from 0 to 4, without trigonometry.
float diamondAngle(float x, float y) {
  const float share = x / (std::fabs(x) + std::fabs(y));
  return y >= 0.0F ? 1.0F - share : 3.0F + share;
}

}  // namespace

ScanCells::ScanCells(const ElevationParams& params, const WindowGrid& grid)
    : side_(grid.side()),
      cell_m_(static_cast<float>(params.cell_m)),
      clearance_m_(static_cast<float>(params.clearance_m)),
      climb_(static_cast<float>(std::tan(params.climb_deg * M_PI / 180.0))),
      half_body_m_(0.5F * params.body_m.cast<float>()),
      stacks_(static_cast<std::size_t>(side_) * side_, Stack{kInf, -kInf, 0.0F, 0}),
      sectors_(kSectors) {}

void ScanCells::collect(const std::vector<Eigen::Vector3f>& points, const WindowFrame& frame,
                        const WindowGrid& grid, const std::vector<float>& heights,
                        ElevationUpdate& update) {
  cells_.clear();
  heights_.clear();
  sectors_.assign(kSectors, Sector{});
  update.points = static_cast<int>(points.size());
  for (std::size_t i = 0; i < points.size(); i += kBlock)
    sortBlock(points.data() + i, std::min(kBlock, points.size() - i), frame, update);
  reduce(grid, heights, update);
}

void ScanCells::sortBlock(const Eigen::Vector3f* points, std::size_t count,
                          const WindowFrame& frame, ElevationUpdate& update) {
  std::array<float, kBlock> x;
  std::array<float, kBlock> y;
  std::array<float, kBlock> z;
  const Eigen::Matrix3f& r = frame.R_window_sensor;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f& p = points[i];
    x[i] = r(0, 0) * p.x() + r(0, 1) * p.y() + r(0, 2) * p.z() + frame.sensor.x();
    y[i] = r(1, 0) * p.x() + r(1, 1) * p.y() + r(1, 2) * p.z() + frame.sensor.y();
    z[i] = r(2, 0) * p.x() + r(2, 1) * p.y() + r(2, 2) * p.z() + frame.sensor.z();
  }
  const float extent = static_cast<float>(side_) * cell_m_;
  const float per_cell = 1.0F / cell_m_;
  const float body_radius = half_body_m_.norm();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f point(x[i], y[i], z[i]);
    if (!(std::fabs(x[i]) + std::fabs(y[i]) + std::fabs(z[i]) < kFarthest_m)) {
      ++update.dropped_not_finite;
      continue;
    }
    if (!(x[i] >= 0.0F && x[i] < extent && y[i] >= 0.0F && y[i] < extent)) {
      ++update.dropped_outside;
      addFar(point - frame.sensor);
      continue;
    }
    const float distance = (point.head<2>() - frame.base.head<2>()).norm();
    if (distance < body_radius &&
        ((frame.T_base_window * point).array().abs() <= half_body_m_.array()).all()) {
      ++update.dropped_self;
      continue;
    }
    if (z[i] > frame.foot_z + clearance_m_ + climb_ * distance) {
      ++update.dropped_high;
      continue;
    }
    const int column = std::min(static_cast<int>(x[i] * per_cell), side_ - 1);
    const int row = std::min(static_cast<int>(y[i] * per_cell), side_ - 1);
    const auto cell = static_cast<std::uint32_t>(row * side_ + column);
    Stack& stack = stacks_[cell];
    if (stack.lowest == kInf) touched_.push_back(cell);
    stack.lowest = std::min(stack.lowest, z[i]);
    cells_.push_back(cell);
    heights_.push_back(z[i]);
  }
}

void ScanCells::addFar(const Eigen::Vector3f& from_sensor) {
  if (from_sensor.z() >= 0.0F) return;
  const float distance = from_sensor.head<2>().norm();
  if (!(distance > 0.0F)) return;
  const float angle = diamondAngle(from_sensor.x(), from_sensor.y());
  const int index = std::min(static_cast<int>(angle * (kSectors / 4)), kSectors - 1);
  Sector& sector = sectors_[static_cast<std::size_t>(index)];
  const float fall = -from_sensor.z() / distance;
  if (fall <= sector.fall) return;
  sector.fall = fall;
  sector.direction = from_sensor.head<2>() / distance;
}

void ScanCells::reduce(const WindowGrid& grid, const std::vector<float>& heights,
                       ElevationUpdate& update) {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Stack& stack = stacks_[cells_[i]];
    if (heights_[i] <= stack.lowest + clearance_m_) stack.top = std::max(stack.top, heights_[i]);
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Stack& stack = stacks_[cells_[i]];
    if (heights_[i] > stack.top) {
      ++update.dropped_high;
    } else if (heights_[i] >= stack.top - kTopBand_m) {
      stack.sum += heights_[i];
      ++stack.count;
    }
  }
  measures_.clear();
  for (const std::uint32_t cell : touched_) {
    Stack& stack = stacks_[cell];
    const int x = static_cast<int>(cell) % side_;
    const int y = static_cast<int>(cell) / side_;
    const float known = heights[grid.slotOf(grid.first().x() + x, grid.first().y() + y)];
    if (stack.lowest > known + clearance_m_)
      update.dropped_high += stack.count;
    else
      measures_.push_back(
          {x, y, stack.lowest, stack.sum / static_cast<float>(stack.count), stack.count});
    stack = Stack{kInf, -kInf, 0.0F, 0};
  }
  touched_.clear();
}

}  // namespace spelunk::terrain
