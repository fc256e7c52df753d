#include "spelunk/evaluation/target_voxels.h"

#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::evaluation {
namespace {

constexpr std::int32_t kNothing = -1;

}  // namespace

TargetVoxels::TargetVoxels(const ReachableSpace& space, double edge_m) : edge_m_(edge_m) {
  require(edge_m >= space.free.resolution(), "TargetVoxels: finer than the space itself");
  const Eigen::Vector3i last_cell = space.free.size() - Eigen::Vector3i::Ones();
  first_ = cellOf(space.free.centreOf(Eigen::Vector3i::Zero()));
  shape_.size = cellOf(space.free.centreOf(last_cell)) - first_ + Eigen::Vector3i::Ones();
  numbers_.assign(shape_.count(), kNothing);
  const double voxel_m3 = std::pow(space.free.resolution(), 3);
  const auto take = [&](const VoxelGrid& grid) {
    grid.forEachSet([&](std::size_t offset) {
      const Eigen::Vector3i cell = cellOf(grid.centreOf(grid.cellAt(offset)));
      std::int32_t& number = numbers_[shape_.offsetOf(cell - first_)];
      if (number == kNothing) {
        number = static_cast<std::int32_t>(centres_.size());
        centres_.emplace_back(edge_m_ * (cell.cast<double>().array() + 0.5));
        volumes_m3_.push_back(0.0);
      }
      volumes_m3_[static_cast<std::size_t>(number)] += voxel_m3;
    });
  };
  take(space.free);
  take(space.surface);
}

Eigen::Vector3i TargetVoxels::cellOf(const Eigen::Vector3d& point) const {
  return (point / edge_m_).array().floor().cast<int>();
}

std::optional<std::size_t> TargetVoxels::find(const Eigen::Vector3d& point) const {
  const Eigen::Vector3i cell = cellOf(point) - first_;
  if (!shape_.contains(cell)) return std::nullopt;
  const std::int32_t number = numbers_[shape_.offsetOf(cell)];
  if (number == kNothing) return std::nullopt;
  return static_cast<std::size_t>(number);
}

}  // namespace spelunk::evaluation
