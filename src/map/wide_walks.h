#pragma once

#include <cstdint>

#include "ray_grid.h"
#include "spelunk/common/wide_loops.h"

namespace spelunk::map {

/// Marks what the walks pass through, eight of them at a time. Additions and comparisons only, so
/// the same voxels as one by one. Only where hasEightLanes().
void walkThroughByEights(const RayWalks& walks, const RayGrid& grid, std::uint64_t* words);

}  // namespace spelunk::map
