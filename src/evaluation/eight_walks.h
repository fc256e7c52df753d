#pragma once

#include "ray_block.h"
#include "spelunk/common/wide_loops.h"

namespace spelunk::evaluation {

/// The same as mark(). Only where hasEightLanes().
std::size_t markByEights(const RayBlock& rays, VoxelGrid& grid);

}  // namespace spelunk::evaluation
