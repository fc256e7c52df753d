#pragma once

#include "ray_block.h"

namespace spelunk::evaluation {

/// Whether this processor has the registers (AVX-512) to walk eight rays at once.
[[nodiscard]] bool hasEightLanes();

/// The same as mark(). Only where hasEightLanes().
std::size_t markByEights(const RayBlock& rays, VoxelGrid& grid);

}  // namespace spelunk::evaluation
