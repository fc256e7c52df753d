#include "scan_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spelunk::terrain {
namespace {

constexpr std::size_t kBlock = 256;
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
  using Lane = Eigen::Array<float, kBlock, 1>;
  Lane x;
  Lane y;
  Lane z;
  Lane odd;  ///< At most 0 for points in the window, not high and not near the body.
};

void ScanCells::fill(const Eigen::Vector3f* points, std::size_t count, const WindowFrame& frame,
                     Block& block) const {
  Block::Lane px = Block::Lane::Zero();
  Block::Lane py = Block::Lane::Zero();
  Block::Lane pz = Block::Lane::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const auto lane = static_cast<Eigen::Index>(i);
    px(lane) = points[i].x();
    py(lane) = points[i].y();
    pz(lane) = points[i].z();
  }
  const Eigen::Matrix3f& r = frame.R_window_sensor;
  block.x = r(0, 0) * px + r(0, 1) * py + r(0, 2) * pz + frame.sensor.x();
  block.y = r(1, 0) * px + r(1, 1) * py + r(1, 2) * pz + frame.sensor.y();
  block.z = r(2, 0) * px + r(2, 1) * py + r(2, 2) * pz + frame.sensor.z();
  const float high = frame.foot_z + clearance_m_;
  const float extent = static_cast<float>(side_) * cell_m_;
  const float body_radius = half_body_m_.norm();
  px = ((block.x - frame.base.x()).square() + (block.y - frame.base.y()).square()).sqrt();
  py = (block.z - (high + climb_ * px)).max(body_radius - px);
  pz = (-block.x).max(block.x - extent).max(-block.y).max(block.y - extent);
  block.odd = py.max(pz) + 0.0F * (block.x + block.y + block.z);  // not finite: not a number
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
  fill(points, count, frame, block);
  const float per_cell = 1.0F / cell_m_;
  const int side = side_;
  Stack open = open_;  // a local: its members stay in registers
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(count); ++i) {
    const float z = block.z(i);
    if (!(block.odd(i) <= 0.0F) && !isKept({block.x(i), block.y(i), z}, frame, update)) continue;
    const int column = std::min(static_cast<int>(block.x(i) * per_cell), side - 1);
    const int row = std::min(static_cast<int>(block.y(i) * per_cell), side - 1);
    const auto cell = static_cast<std::uint32_t>(row * side + column);
    cells_[used_] = cell;
    heights_[used_++] = z;
    if (cell != open_cell_) open = exchangeStack(open, cell);
    open.lowest = std::min(open.lowest, z);
    open.highest = std::max(open.highest, z);
    open.sum += z;
    ++open.count;
  }
  open_ = open;
}

ScanCells::Stack ScanCells::exchangeStack(const Stack& open, std::uint32_t cell) {
  stacks_[open_cell_] = open;
  open_cell_ = cell;
  if (stacks_[cell].count == 0) touched_.push_back(cell);
  return stacks_[cell];
}

bool ScanCells::isKept(const Eigen::Vector3f& point, const WindowFrame& frame,
                       ElevationUpdate& update) {
  const float extent = static_cast<float>(side_) * cell_m_;
  const float distance = (point - frame.base).head<2>().norm();
  if (!point.allFinite() || !(point.cwiseAbs().maxCoeff() < kFarthest_m)) {
    ++update.dropped_not_finite;
  } else if ((point.head<2>().array() < 0.0F).any() || (point.head<2>().array() > extent).any()) {
    ++update.dropped_outside;
    rays_.add(point - frame.sensor);
  } else if (((frame.T_base_window * point).array().abs() <= half_body_m_.array()).all()) {
    ++update.dropped_self;
  } else if (point.z() > frame.foot_z + clearance_m_ + climb_ * distance) {
    ++update.dropped_high;
  } else {
    return true;
  }
  return false;
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
