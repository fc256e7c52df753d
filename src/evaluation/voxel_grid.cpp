#include "spelunk/evaluation/voxel_grid.h"

#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/mesh_size.h"

namespace spelunk::evaluation {
namespace {

constexpr double kVoxelsMax = 8e9;  // 1 GB of bits; a mission holds five such grids

void requireSize(const AxisAlignedBox& bounds, double resolution_m, double voxels) {
  if (voxels < kVoxelsMax) return;
  std::ostringstream text;
  text << "a world of " << sim::sizeText(bounds) << " is too large for voxels of " << resolution_m
       << " m (at most " << kVoxelsMax << ")" << sim::sizeAdvice(bounds);
  throw OutsideError(text.str());
}

}  // namespace

VoxelGrid::VoxelGrid(const AxisAlignedBox& bounds, double resolution_m)
    : resolution_m_(resolution_m), inverse_resolution_(1.0 / resolution_m) {
  require(resolution_m > 0.0, "VoxelGrid: resolution must be positive");
  require(!bounds.isEmpty() && bounds.size().allFinite(), "VoxelGrid: bounds must be finite");
  const Eigen::Array3d first = (bounds.min.array() / resolution_m).floor() - 1.0;
  const Eigen::Array3d last = (bounds.max.array() / resolution_m).floor() + 1.0;
  requireSize(bounds, resolution_m, ((last - first) + 1.0).prod());
  corner_ = resolution_m * first.matrix();
  shape_.size = (last - first).cast<int>().matrix() + Eigen::Vector3i::Ones();
  words_.assign((shape_.count() - 1) / 64 + 1, 0);
}

Eigen::Vector3d VoxelGrid::centreOf(const Eigen::Vector3i& cell) const {
  return corner_ + resolution_m_ * (cell.cast<double>() + Eigen::Vector3d::Constant(0.5));
}

}  // namespace spelunk::evaluation
