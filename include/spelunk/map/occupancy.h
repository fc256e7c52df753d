#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace spelunk::map {

/// What is known of a voxel. Unknown is never free.
enum class Occupancy : std::uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

/// Index of a voxel: floor(coordinate / resolution) on each axis (OctoMap's key minus 32768).
using VoxelIndex = Eigen::Vector3i;

}  // namespace spelunk::map
