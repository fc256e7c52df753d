#include "scan_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/wide_loops.h"

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
      stacks_(static_cast<std::size_t>(side_) * side_, kEmpty),
      touched_(stacks_.size() + 1),
      is_tall_(stacks_.size(), 0),
      rays_(params.cell_m, 1.7 * params.reach_m) {}

/// Points of a block in the window's frame.
struct ScanCells::Block {
  alignas(64) float x[kBlock];
  alignas(64) float y[kBlock];
  alignas(64) float z[kBlock];
  alignas(64) float odd[kBlock];  ///< At most 0 for points in the window, not high, off the body.
  alignas(64) std::int32_t cell[kBlock];  ///< By y * side + x; means nothing outside the window.
};

SPELUNK_WIDE_IF_POSSIBLE void ScanCells::fill(const Eigen::Vector3f* points, std::size_t count,
                                              const WindowFrame& frame, Block& block) const {
  const float r00 = frame.R_window_sensor(0, 0), r01 = frame.R_window_sensor(0, 1);
  const float r02 = frame.R_window_sensor(0, 2), r10 = frame.R_window_sensor(1, 0);
  const float r11 = frame.R_window_sensor(1, 1), r12 = frame.R_window_sensor(1, 2);
  const float r20 = frame.R_window_sensor(2, 0), r21 = frame.R_window_sensor(2, 1);
  const float r22 = frame.R_window_sensor(2, 2);
  const float sensor_x = frame.sensor.x(), sensor_y = frame.sensor.y();
  const float sensor_z = frame.sensor.z();
  const float* from = points->data();
  for (std::size_t i = 0; i < count; ++i) {
    const float px = from[3 * i];
    const float py = from[3 * i + 1];
    const float pz = from[3 * i + 2];
    block.x[i] = r00 * px + r01 * py + r02 * pz + sensor_x;
    block.y[i] = r10 * px + r11 * py + r12 * pz + sensor_y;
    block.z[i] = r20 * px + r21 * py + r22 * pz + sensor_z;
  }
  const float base_x = frame.base.x(), base_y = frame.base.y();
  const float high = frame.foot_z + clearance_m_;
  const float climb = climb_;
  const float extent = static_cast<float>(side_) * cell_m_;
  const float body_radius = half_body_m_.norm();
  for (std::size_t i = 0; i < count; ++i) {
    const float x = block.x[i], y = block.y[i], z = block.z[i];
    const float dx = x - base_x, dy = y - base_y;
    const float distance = std::sqrt(dx * dx + dy * dy);
    const float above = std::max(z - (high + climb * distance), body_radius - distance);
    const float outside = std::max(std::max(-x, x - extent), std::max(-y, y - extent));
    block.odd[i] = std::max(above, outside) + 0.0F * (x + y + z);  // not finite: not a number
  }
  const float per_cell = 1.0F / cell_m_;
  const std::int32_t side = side_;
  const auto last = static_cast<float>(side - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const float column = std::min(std::max(0.0F, block.x[i] * per_cell), last);
    const float row = std::min(std::max(0.0F, block.y[i] * per_cell), last);
    block.cell[i] = static_cast<std::int32_t>(row) * side + static_cast<std::int32_t>(column);
  }
}

void ScanCells::collect(const std::vector<Eigen::Vector3f>& points, const WindowFrame& frame,
                        const WindowGrid& grid, const std::vector<float>& heights,
                        ElevationUpdate& update) {
  if (cells_.size() < points.size()) {
    cells_.resize(points.size());
    heights_.resize(points.size());
  }
  used_ = touched_count_ = 0;
  rays_.clear();
  update.points = static_cast<int>(points.size());
  for (std::size_t i = 0; i < points.size(); i += kBlock)
    sortBlock(points.data() + i, std::min(kBlock, points.size() - i), frame, update);
  cutTallStacks(update);
  measure(frame, grid, heights, update);
  rays_.finish();
}

/// Without branches but the first: neighbours in a scan share a cell or not, and nothing foretells
/// which.
void ScanCells::sortBlock(const Eigen::Vector3f* points, std::size_t count,
                          const WindowFrame& frame, ElevationUpdate& update) {
  Block block;
  fill(points, count, frame, block);
  Stack* const stacks = stacks_.data();
  std::uint32_t* const touched = touched_.data();
  std::uint32_t* const cells = cells_.data();
  float* const heights = heights_.data();
  std::size_t touched_count = touched_count_;
  std::size_t used = used_;
  for (std::size_t i = 0; i < count; ++i) {
    const float z = block.z[i];
    if (!(block.odd[i] <= 0.0F) && !isKept({block.x[i], block.y[i], z}, frame, update)) continue;
    const auto cell = static_cast<std::uint32_t>(block.cell[i]);
    cells[used] = cell;
    heights[used++] = z;
    Stack& stack = stacks[cell];
    touched[touched_count] = cell;
    touched_count += stack.count == 0 ? 1 : 0;
    stack.lowest = std::min(stack.lowest, z);
    stack.highest = std::max(stack.highest, z);
    stack.sum += z;
    ++stack.count;
  }
  touched_count_ = touched_count;
  used_ = used;
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
  const auto isTall = [](const Stack& stack) { return stack.highest - stack.lowest > kTopBand_m; };
  for (std::size_t i = 0; i < touched_count_; ++i) {
    const std::uint32_t cell = touched_[i];
    Stack& stack = stacks_[cell];
    if (!isTall(stack)) continue;
    tall_cells_.push_back(cell);
    is_tall_[cell] = 1;
    stack.count = 0;
    stack.sum = 0.0F;
    stack.highest = -kInf;
  }
  if (tall_cells_.empty()) return;
  for (std::size_t i = 0; i < used_; ++i) {
    if (is_tall_[cells_[i]] == 0) continue;
    tall_points_.push_back(static_cast<std::uint32_t>(i));
    Stack& stack = stacks_[cells_[i]];
    if (heights_[i] <= stack.lowest + clearance_m_)
      stack.highest = std::max(stack.highest, heights_[i]);
  }
  for (const std::uint32_t i : tall_points_) {
    Stack& stack = stacks_[cells_[i]];
    if (heights_[i] > stack.highest) {
      ++update.dropped_high;
    } else if (heights_[i] >= stack.highest - kTopBand_m) {
      stack.sum += heights_[i];
      ++stack.count;
    }
  }
  for (const std::uint32_t cell : tall_cells_) is_tall_[cell] = 0;
  tall_cells_.clear();
  tall_points_.clear();
}

void ScanCells::measure(const WindowFrame& frame, const WindowGrid& grid,
                        const std::vector<float>& heights, ElevationUpdate& update) {
  measures_.clear();
  for (std::size_t i = 0; i < touched_count_; ++i) {
    const std::uint32_t cell = touched_[i];
    Stack& stack = stacks_[cell];
    const int x = static_cast<int>(cell) % side_;
    const int y = static_cast<int>(cell) / side_;
    const int count = stack.count;
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
}

}  // namespace spelunk::terrain
