#include <algorithm>
#include <cmath>
#include <limits>

#include "scan_cells.h"
#include "spelunk/terrain/elevation_map.h"

namespace spelunk::terrain {
namespace {

constexpr float kLeastVariance = 0.003F * 0.003F;  // below it lies what a cell's height means
constexpr int kIndependent = 4;   // returns of one scan in a cell; more share their errors
constexpr int kSearchCells = 2;   // between cells looked at for ground on the way to the robot
constexpr int kPauseMax = 8;      // scans between two looks at a cell that may hang
constexpr float kBelow_m = 0.3F;  // ground may lie so much lower than the robot's slope limit lets

}  // namespace

void ElevationMap::fuseCells(const Eigen::Vector3f& sensor, float stamp, ElevationUpdate& update) {
  const auto high = static_cast<float>(foot_z_ + params_.clearance_m);
  std::vector<std::size_t> high_ones;
  const std::vector<CellMeasure>& measures = scan_cells_->measures();
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (measures[i].lowest > high)
      high_ones.push_back(i);
    else
      fuse(measures[i], sensor, stamp, update);
  }
  const auto hanging = std::stable_partition(high_ones.begin(), high_ones.end(),
                                             [&](std::size_t i) { return !hangs(measures[i]); });
  for (auto i = high_ones.begin(); i != hanging; ++i) {
    const CellMeasure& measure = measures[*i];
    const CellIndex cell = grid_.first() + CellIndex(measure.x, measure.y);
    const bool is_new = std::isnan(height_[grid_.slotOf(cell)]);
    fuse(measure, sensor, stamp, update);
    if (is_new) high_cells_.push_back({cell, measure.lowest, 1, 1});
  }
  for (auto i = hanging; i != high_ones.end(); ++i) update.dropped_high += measures[*i].count;
  forgetHanging();
}

void ElevationMap::forgetHanging() {
  const auto is_done = [this](HighCell& high) {
    if (--high.wait > 0) return false;
    high.wait = high.pause = std::min(2 * high.pause, kPauseMax);
    if (!grid_.contains(high.cell)) return true;
    const std::size_t slot = grid_.slotOf(high.cell);
    // Replaced by what lies lower, or forgotten with the window.
    if (!(height_[slot] >= high.lowest - kTopBand_m)) return true;
    if (!hangs(high.cell, high.lowest)) return false;
    height_[slot] = std::numeric_limits<float>::quiet_NaN();
    other_count_[slot] = 0;
    changed_.push_back(high.cell);
    return true;
  };
  high_cells_.erase(std::remove_if(high_cells_.begin(), high_cells_.end(), is_done),
                    high_cells_.end());
}

bool ElevationMap::hangs(const CellMeasure& measure) const {
  const CellIndex cell = grid_.first() + CellIndex(measure.x, measure.y);
  if (!std::isnan(height_[grid_.slotOf(cell)])) return false;  // ScanCells has looked at it
  return hangs(cell, measure.lowest);
}

bool ElevationMap::hangs(const CellIndex& cell, float lowest) const {
  const auto cell_m = static_cast<float>(params_.cell_m);
  const auto climb = static_cast<float>(std::tan(params_.climb_deg * M_PI / 180.0));
  const Eigen::Vector2f way = (grid_.middle() - cell).cast<float>();
  const float length = way.norm();
  for (int at = kSearchCells; static_cast<float>(at) < length; at += kSearchCells) {
    const auto gone = static_cast<float>(at);
    const Eigen::Vector2f step = way * (gone / length);
    const CellIndex there = cell + CellIndex(static_cast<int>(std::lround(step.x())),
                                             static_cast<int>(std::lround(step.y())));
    const float ground = height_[grid_.slotOf(there)];
    const float least = static_cast<float>(foot_z_) - climb * (length - gone) * cell_m - kBelow_m;
    if (!(ground >= least)) continue;  // unknown, or the bottom of a hole
    if (lowest > ground + static_cast<float>(params_.clearance_m) + climb * gone * cell_m)
      return true;
  }
  return false;
}

void ElevationMap::start(std::size_t slot, float height, float variance) {
  height_[slot] = height;
  variance_[slot] = variance;
  other_count_[slot] = 0;
}

void ElevationMap::fuse(const CellMeasure& measure, const Eigen::Vector3f& sensor, float stamp,
                        ElevationUpdate& update) {
  const auto cell_m = static_cast<float>(params_.cell_m);
  const CellIndex cell = grid_.first() + CellIndex(measure.x, measure.y);
  const std::size_t slot = grid_.slotOf(cell);
  const Eigen::Vector3f centre((static_cast<float>(measure.x) + 0.5F) * cell_m,
                               (static_cast<float>(measure.y) + 0.5F) * cell_m, measure.height);
  const float deviation =
      static_cast<float>(params_.noise_base_m) +
      static_cast<float>(params_.noise_quadratic_1pm) * (centre - sensor).squaredNorm();
  const float within_cell = cell_m * cell_m / 16.0F;
  const float noise =
      deviation * deviation / static_cast<float>(std::min(measure.count, kIndependent)) +
      within_cell;
  const float before = height_[slot];
  if (std::isnan(before)) {
    start(slot, measure.height, noise);
    ++update.cells_started;
  } else if (!correct(slot, measure.height, noise, update)) {
    return;
  }
  stamp_[slot] = stamp;
  if (height_[slot] != before) changed_.push_back(cell);
}

bool ElevationMap::correct(std::size_t slot, float measured, float noise, ElevationUpdate& update) {
  const auto gate = static_cast<float>(params_.gate_sigmas * params_.gate_sigmas);
  const float innovation = measured - height_[slot];
  const float spread = variance_[slot] + noise;
  if (innovation * innovation <= gate * spread) {
    const float gain = variance_[slot] / spread;
    height_[slot] += gain * innovation;
    variance_[slot] = std::max(kLeastVariance, variance_[slot] * (1.0F - gain));
    // What lies lower by the clearance is ground under an overhang: both are seen, in turns.
    const bool is_overhang =
        other_height_[slot] < height_[slot] - static_cast<float>(params_.clearance_m);
    if (!is_overhang) other_count_[slot] = 0;
    ++update.cells_fused;
    return true;
  }
  ++update.cells_in_conflict;
  const float apart = measured - other_height_[slot];
  const bool agrees = other_count_[slot] > 0 && apart * apart <= gate * (noise + noise);
  other_count_[slot] = static_cast<std::uint8_t>(agrees ? other_count_[slot] + 1 : 1);
  other_height_[slot] = measured;
  if (other_count_[slot] < params_.conflicts_to_replace) return false;
  start(slot, measured, noise);
  ++update.cells_started;
  return true;
}

}  // namespace spelunk::terrain
