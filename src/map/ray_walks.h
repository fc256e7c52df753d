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
  int step[3];     ///< -1, 0 or 1
  VoxelIndex end;  ///< Not marked.
  double length;   ///< A border beyond it is not crossed: rounding can lead past the end's voxel.
};

/// The rays of one scan, number by number beside each other so that several are walked at once.
struct RayWalks {
  VoxelIndex start;  ///< Of all rays; always marked.
  std::vector<double> next[3];
  std::vector<double> spacing[3];
  std::vector<std::int32_t> step[3];
  std::vector<std::int32_t> end[3];
  std::vector<double> length;
  std::size_t count = 0;  ///< Of rays; the vectors are longer.

  /// Sets `count` and makes room for whole groups of eight rays.
  void resize(std::size_t rays);
  void set(std::size_t i, const RayWalk& walk);
  [[nodiscard]] RayWalk at(std::size_t i) const;
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

  void markFree(const RayWalks& walks, ScanMarks& marks);

  /// The same, one ray and one voxel after the other, straight into the blocks: for rays that reach
  /// too far for a dense grid.
  static void markFreeOneByOne(const RayWalks& walks, ScanMarks& marks);

 private:
  WalkLanes lanes_;
  std::vector<std::uint64_t> words_;  ///< Kept, so that no scan allocates.
};

}  // namespace spelunk::map
