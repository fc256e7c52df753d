#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "spelunk/evaluation/voxel_grid.h"

namespace spelunk::evaluation {

/// Up to 256 rays from one point of a grid, as numbers beside each other; point and lengths in
/// voxels.
struct RayBlock {
  static constexpr std::size_t kRays = 256;

  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  std::size_t count = 0;        ///< Rays in use.
  alignas(64) double x[kRays];  ///< Directions, of unit length.
  alignas(64) double y[kRays];
  alignas(64) double z[kRays];
  alignas(64) double length[kRays];
};

/// Voxels; walks end this far before the grid's end, so that rounding does not lead out of it.
constexpr double kInside = 1e-6;

/// Sets the voxels the rays pass on their way to their lengths or the grid's end; how many of
/// them were clear before.
std::size_t mark(const RayBlock& rays, VoxelGrid& grid);

/// The same on any processor.
std::size_t markOneByOne(const RayBlock& rays, VoxelGrid& grid);

}  // namespace spelunk::evaluation
