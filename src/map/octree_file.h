#pragma once

#include <octomap/OcTree.h>

#include <string>

#include "block_map.h"
#include "spelunk/common/local_frame.h"

namespace spelunk::map {

enum class OctreeFormat { kMaximumLikelihood, kFull };  ///< .bt and .ot

/// By the ending of the path; throws OutsideError for any other ending.
OctreeFormat octreeFormatOf(const std::string& path);

/// Writes beside `path` and renames, so that a failure leaves the old file whole. A comment in the
/// header names the origin of `frame`, where that is not the caller's own. Throws OutsideError with
/// path and reason.
void writeOctree(const octomap::OcTree& tree, OctreeFormat format, const std::string& path,
                 const LocalFrame& frame);

/// Enters the leaves of a file into `blocks`. Throws OutsideError if the file is missing, not an
/// octree, cut short, or of another resolution. Reads by itself because OctoMap's reader trusts
/// its input.
void readOctree(const std::string& path, double resolution_m, BlockMap& blocks);

}  // namespace spelunk::map
