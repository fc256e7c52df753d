#include "spelunk/evaluation/voxel_grid.h"

#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::evaluation {
namespace {

constexpr double kVoxelsMax = 3.2e10;  // 4 GB of bits

}  // namespace

VoxelGrid::VoxelGrid(const AxisAlignedBox& bounds, double resolution_m)
    : resolution_m_(resolution_m), inverse_resolution_(1.0 / resolution_m) {
  require(resolution_m > 0.0, "VoxelGrid: resolution must be positive");
  require(!bounds.isEmpty() && bounds.size().allFinite(), "VoxelGrid: bounds must be finite");
  const Eigen::Array3d first = (bounds.min.array() / resolution_m).floor() - 1.0;
  const Eigen::Array3d last = (bounds.max.array() / resolution_m).floor() + 1.0;
  require(((last - first) + 1.0).prod() < kVoxelsMax,
          "VoxelGrid: the world is too large for its resolution");
  corner_ = resolution_m * first.matrix();
  shape_.size = (last - first).cast<int>().matrix() + Eigen::Vector3i::Ones();
  words_.assign((shape_.count() - 1) / 64 + 1, 0);
}

Eigen::Vector3d VoxelGrid::centreOf(const Eigen::Vector3i& cell) const {
  return corner_ + resolution_m_ * (cell.cast<double>() + Eigen::Vector3d::Constant(0.5));
}

}  // namespace spelunk::evaluation
