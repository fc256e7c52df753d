#pragma once

#include <cstdint>
#include <vector>

#include "scan_marks.h"

namespace spelunk::map {

/// A ray on its way through the voxels: on each axis the length at which it crosses the next
/// border, the length between borders and the direction of its steps.
struct RayWalk {
  double next[3];
  double spacing[3];
  int step[3];       ///< -1, 0 or 1
  VoxelIndex start;  ///< Always marked.
  VoxelIndex end;    ///< Not marked.
  double length;     ///< A border beyond it is not crossed: rounding can lead past the end's voxel.
};

/// How many rays are walked at once.
enum class WalkLanes { kOne, kEight };

/// Marks the voxels that walks pass through as free. Rays are walked through a dense grid of bits
/// around all of them, where a step is an addition; whole blocks are collected from it afterwards.
class RayMarker {
 public:
  /// Throws Precondition if the processor has no such registers. The marks are the same.
  explicit RayMarker(WalkLanes lanes = most());

  /// What this processor does fastest.
  [[nodiscard]] static WalkLanes most();

  void markFree(const std::vector<RayWalk>& walks, ScanMarks& marks);

  /// The same, one ray and one voxel after the other, straight into the blocks: for rays that reach
  /// too far for a dense grid.
  static void markFreeOneByOne(const std::vector<RayWalk>& walks, ScanMarks& marks);

 private:
  WalkLanes lanes_;
  std::vector<std::uint64_t> words_;  ///< Kept, so that no scan allocates.
};

}  // namespace spelunk::map
