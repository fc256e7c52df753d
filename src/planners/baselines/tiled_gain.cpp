#include "spelunk/planners/baselines/tiled_gain.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spelunk::planners::baselines {
namespace {

constexpr double kTile_m = 60.0;  // windows reach beyond it: smaller ones copy more in all

double inVoxels(double metres, double resolution_m) {
  return std::ceil(metres / resolution_m) * resolution_m;
}

}  // namespace

TiledGain::TiledGain(std::shared_ptr<const map::FrozenMap> map, const map::GainEvaluator& evaluator,
                     const AxisAlignedBox& bounds, map::KeptWindow& window, double cells_max)
    : map_(std::move(map)),
      evaluator_(evaluator),
      bounds_(bounds),
      side_m_(inVoxels(kTile_m, map_->resolution())),
      margin_m_(inVoxels(evaluator.reach(), map_->resolution())) {
  const AxisAlignedBox known = map_->knownBounds();
  if (known.isEmpty()) return;
  const double inset = 0.5 * map_->resolution();
  const Eigen::Vector3d margin(margin_m_, margin_m_, inset);
  region_ = map::roundedOut(*map_, {known.min - margin, known.max + margin});
  const Eigen::Vector3d cells = (region_.max - region_.min) / map_->resolution();
  if (cells.prod() <= cells_max) whole_ = &window.over(map_, region_);
}

double TiledGain::visibleFrom(const Pose& pose) {
  const Eigen::Vector3d& from = pose.position;
  if (whole_ != nullptr && region_.contains(from))
    return evaluator_.evaluate(*whole_, from, pose.yaw, intersection(bounds_, region_)).unknown_m3;
  return evaluator_.evaluate(windowAround(from), from, pose.yaw, bounds_).unknown_m3;
}

const map::LocalWindow& TiledGain::windowAround(const Eigen::Vector3d& position) {
  const auto number = [&](double along) { return static_cast<int>(std::floor(along / side_m_)); };
  const Tile tile{number(position.x()), number(position.y())};
  const auto known = windows_.find(tile);
  if (known != windows_.end()) return known->second;
  // Half a voxel inside its edges, so that all windows have as many cells.
  const double inset = 0.5 * map_->resolution();
  const AxisAlignedBox heights = map_->knownBounds();
  const Eigen::Vector3d corner(tile.first * side_m_, tile.second * side_m_, 0.0);
  AxisAlignedBox region{corner.array() - margin_m_ + inset,
                        corner.array() + side_m_ + margin_m_ - inset};
  region.min.z() = std::min(heights.min.z(), position.z()) - inset;
  region.max.z() = std::max(heights.max.z(), position.z()) + inset;
  return windows_.try_emplace(tile, *map_, region).first->second;
}

}  // namespace spelunk::planners::baselines
