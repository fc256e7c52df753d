#include "spelunk/terrain/elevation_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scan_cells.h"
#include "spelunk/common/contract.h"

namespace spelunk::terrain {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr float kBoundDrift = 0.01F;   // of an odometry's height, a metre of way
constexpr float kDriftStep_m = 0.01F;  // added in steps: each concerns the whole map
constexpr float kAssumedVariance = 0.05F * 0.05F;
constexpr float kNews_m = 0.001F;  // a bound that falls less stays
constexpr double kStill_m = 1e-4;  // a move below this is none

bool isRigid(const Eigen::Isometry3d& T) {
  if (!T.matrix().allFinite()) return false;
  const Eigen::Matrix3d R = T.linear();
  return (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 &&
         R.determinant() > 0.0;
}

WindowFrame frameOf(const WindowGrid& grid, const Scan& scan, const Eigen::Isometry3d& T_world_base,
                    double foot_z) {
  Eigen::Isometry3d T_world_window = Eigen::Isometry3d::Identity();
  T_world_window.translation().head<2>() = grid.first().cast<double>() * grid.cell();
  const Eigen::Isometry3d T_window_sensor = T_world_window.inverse() * scan.T_world_sensor;
  const Eigen::Isometry3d T_window_base = T_world_window.inverse() * T_world_base;
  WindowFrame frame;
  frame.R_window_sensor = T_window_sensor.linear().cast<float>();
  frame.sensor = T_window_sensor.translation().cast<float>();
  frame.base = T_window_base.translation().cast<float>();
  frame.T_base_window = T_window_base.inverse().cast<float>();
  frame.foot_z = static_cast<float>(foot_z);
  return frame;
}

}  // namespace

std::vector<std::string> ElevationParams::problems() const {
  std::vector<std::string> problems;
  if (reach_m < 2.0 * cell_m) problems.emplace_back("terrain.reach_m must hold two cells");
  if (reach_m / cell_m > 2000.0)
    problems.emplace_back("terrain.reach_m holds more than 2000 cells of terrain.cell_m");
  return problems;
}

ElevationMap::ElevationMap(const ElevationParams& params)
    : params_(params),
      grid_(params.cell_m, params.reach_m),
      height_(grid_.slots(), kUnknown),
      variance_(grid_.slots(), 0.0F),
      stamp_(grid_.slots(), 0.0F),
      bound_(grid_.slots(), kInf),
      other_height_(grid_.slots(), 0.0F),
      other_count_(grid_.slots(), 0),
      scan_cells_(std::make_unique<ScanCells>(params, grid_)) {}
ElevationMap::~ElevationMap() = default;
ElevationMap::ElevationMap(ElevationMap&&) noexcept = default;
ElevationMap& ElevationMap::operator=(ElevationMap&&) noexcept = default;

ElevationUpdate ElevationMap::insert(const Scan& scan, const Eigen::Isometry3d& T_world_base) {
  ElevationUpdate update;
  update.verdict = ScanVerdict::kRefused;
  if (!isRigid(T_world_base) || !isRigid(scan.T_world_sensor) || !std::isfinite(scan.stamp_s))
    return update;
  const Eigen::Vector3d position = T_world_base.translation();
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  if ((sensor - position).cwiseAbs().maxCoeff() > params_.reach_m - 2.0 * params_.cell_m ||
      position.cwiseAbs().maxCoeff() > 1e6)
    return update;

  changed_.clear();
  moveWindow(grid_.cellOf(position.head<2>()));
  growUncertainty(position, scan.stamp_s);
  foot_z_ = position.z() - params_.base_height_m;
  const WindowFrame frame = frameOf(grid_, scan, T_world_base, foot_z_);
  scan_cells_->collect(scan.points, frame, grid_, height_, update);
  fuseCells(frame.sensor, static_cast<float>(scan.stamp_s - first_stamp_s_), update);
  lowerBounds(frame.sensor);
  const int usable = update.points - update.dropped_not_finite - update.dropped_self;
  update.verdict = usable > 0 ? ScanVerdict::kUsed : ScanVerdict::kEmpty;
  return update;
}

void ElevationMap::moveWindow(const CellIndex& middle) {
  const CellIndex old = grid_.first();
  grid_.moveTo(middle);
  const CellIndex first = grid_.first();
  const CellIndex end = first.array() + grid_.side();
  const CellIndex shift = (first - old).cwiseAbs().cwiseMin(grid_.side());
  const int x = shift.x();
  const int y = shift.y();
  if (x > 0 && first.x() > old.x()) forget({end.x() - x, first.y()}, end);
  if (x > 0 && first.x() < old.x()) forget(first, {first.x() + x, end.y()});
  if (y > 0 && first.y() > old.y()) forget({first.x(), end.y() - y}, end);
  if (y > 0 && first.y() < old.y()) forget(first, {end.x(), first.y() + y});
}

void ElevationMap::forget(const CellIndex& first, const CellIndex& end) {
  for (int y = first.y(); y < end.y(); ++y)
    for (int x = first.x(); x < end.x(); ++x) {
      const std::size_t slot = grid_.slotOf(x, y);
      height_[slot] = kUnknown;
      bound_[slot] = kInf;
      other_count_[slot] = 0;
    }
}

void ElevationMap::growUncertainty(const Eigen::Vector3d& position, double stamp_s) {
  if (!last_position_) first_stamp_s_ = stamp_s;
  const double way = last_position_ ? (position - *last_position_).norm() : 0.0;
  if (way > kStill_m) {
    const double seconds = std::max(0.0, stamp_s - last_stamp_s_);
    const auto growth =
        static_cast<float>(params_.growth_m2_per_m * way + params_.growth_m2_per_s * seconds);
    for (float& variance : variance_) variance += growth;
    pending_drift_m_ += kBoundDrift * static_cast<float>(way);
  }
  changed_everywhere_ = pending_drift_m_ >= kDriftStep_m;
  if (changed_everywhere_) {
    for (float& bound : bound_) bound += pending_drift_m_;
    pending_drift_m_ = 0.0F;
  }
  last_position_ = position;
  last_stamp_s_ = stamp_s;
}

void ElevationMap::lowerBounds(const Eigen::Vector3f& sensor) {
  const auto cell_m = static_cast<float>(params_.cell_m);
  const RayFan& rays = scan_cells_->rays();
  const auto side = static_cast<std::size_t>(grid_.side());
  const Eigen::Vector2f first = Eigen::Vector2f::Constant(0.5F * cell_m) - sensor.head<2>();
  const RayFan::Places places{first, cell_m, grid_.side()};
  const std::vector<RayFan::Range> reach = rays.reachOf(places);
  RayFan::Row row{std::vector<float>(side), std::vector<std::uint32_t>(side)};
  std::vector<std::uint32_t> unknown(side);
  for (int y = 0; y < grid_.side(); ++y) {
    const RayFan::Range& range = reach[static_cast<std::size_t>(y)];
    std::size_t count = 0;
    // Without a branch: unknown cells lie scattered.
    for (int x = range.begin; x < range.end; ++x) {
      unknown[count] = static_cast<std::uint32_t>(x);
      const CellIndex cell = grid_.first() + CellIndex(x, y);
      count += std::isnan(height_[grid_.slotOf(cell)]) ? 1 : 0;
    }
    if (count == 0) continue;
    rays.locate(places, (static_cast<float>(y) + 0.5F) * cell_m - sensor.y(), range, row);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t x = unknown[i];
      const CellIndex cell = grid_.first() + CellIndex(static_cast<int>(x), y);
      const std::size_t slot = grid_.slotOf(cell);
      const float steepest = rays.steepestBeyond(row, x);
      if (steepest == 0.0F) continue;
      const float bound = sensor.z() - steepest * row.distance[x];
      if (bound >= bound_[slot] - kNews_m) continue;
      bound_[slot] = bound;
      changed_.push_back(cell);
    }
  }
}

void ElevationMap::assumeGroundUnder(const Eigen::Isometry3d& T_world_base) {
  require(isRigid(T_world_base), "ElevationMap: pose is not a rigid motion");
  moveWindow(grid_.cellOf(T_world_base.translation().head<2>()));
  changed_.clear();
  changed_everywhere_ = false;
  foot_z_ = T_world_base.translation().z() - params_.base_height_m;
  const Eigen::Vector2d half = 0.5 * params_.body_m.head<2>();
  const Eigen::Isometry3d T_base_world = T_world_base.inverse();
  const int reach = static_cast<int>(half.norm() / params_.cell_m) + 1;
  const CellIndex middle = grid_.middle();
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const CellIndex cell = middle + CellIndex(x, y);
      if (!grid_.contains(cell) || !std::isnan(height_[grid_.slotOf(cell)])) continue;
      const Eigen::Vector2d centre = grid_.centreOf(cell);
      const Eigen::Vector3d in_base =
          T_base_world * Eigen::Vector3d(centre.x(), centre.y(), T_world_base.translation().z());
      if ((in_base.head<2>().array().abs() > half.array()).any()) continue;
      start(grid_.slotOf(cell), static_cast<float>(foot_z_), kAssumedVariance);
      stamp_[grid_.slotOf(cell)] = 0.0F;
      changed_.push_back(cell);
    }
}

std::optional<ElevationCell> ElevationMap::at(const CellIndex& cell) const {
  if (!grid_.contains(cell)) return std::nullopt;
  const std::size_t slot = grid_.slotOf(cell);
  if (std::isnan(height_[slot])) return std::nullopt;
  return ElevationCell{height_[slot], variance_[slot],
                       first_stamp_s_ + static_cast<double>(stamp_[slot])};
}

std::optional<double> ElevationMap::lowerBound(const CellIndex& cell, double sigmas) const {
  const auto known = at(cell);
  if (!known) return std::nullopt;
  return known->height_m - sigmas * std::sqrt(known->variance_m2);
}

std::optional<double> ElevationMap::upperBound(const CellIndex& cell, double sigmas) const {
  const auto known = at(cell);
  if (!known) return std::nullopt;
  return known->height_m + sigmas * std::sqrt(known->variance_m2);
}

std::optional<double> ElevationMap::rayBound(const CellIndex& cell) const {
  if (!grid_.contains(cell)) return std::nullopt;
  const float bound = bound_[grid_.slotOf(cell)];
  if (!std::isfinite(bound)) return std::nullopt;
  return bound;
}

}  // namespace spelunk::terrain
