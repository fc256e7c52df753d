#include "ray_walks.h"

#include <limits>

#include "ray_grid.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/wide_loops.h"
#include "wide_walks.h"

namespace spelunk::map {
namespace {

constexpr std::size_t kWordsMax = std::size_t{1} << 23;  // 64 MB of bits

/// All state of the loop is local: what the marks are written to might else be part of it.
void walkThrough(const RayWalk& walk, const VoxelIndex& start, const RayGrid& grid,
                 std::uint64_t* words) {
  double next_x = walk.next[0];
  double next_y = walk.next[1];
  double next_z = walk.next[2];
  const double spacing[3] = {walk.spacing[0], walk.spacing[1], walk.spacing[2]};
  const std::int64_t step[3] = {walk.step[0] * grid.stride(0), walk.step[1] * grid.stride(1),
                                walk.step[2] * grid.stride(2)};
  const double length = walk.length;
  std::int64_t at = grid.offsetOf(start);
  const std::int64_t end = grid.offsetOf(walk.end);
  double limit = std::numeric_limits<double>::infinity();  // the first voxel always counts
  // Marks the voxel and leaves it by its nearest border; false if that lies beyond the ray's end.
  const auto leave = [&](double& border, int axis) {
    if (border > limit) return false;
    words[at >> 6] |= std::uint64_t{1} << (at & 63);
    at += step[axis];
    border += spacing[axis];
    limit = length;
    return at != end;
  };
  for (bool is_going = true; is_going;) {
    if (next_x < next_y)
      is_going = next_x < next_z ? leave(next_x, 0) : leave(next_z, 2);
    else
      is_going = next_y < next_z ? leave(next_y, 1) : leave(next_z, 2);
  }
}

void walkThroughAll(const RayWalks& walks, const RayGrid& grid, WalkLanes lanes,
                    std::uint64_t* words) {
  if (lanes == WalkLanes::kEight) return walkThroughByEights(walks, grid, words);
  for (std::size_t i = 0; i < walks.count; ++i) walkThrough(walks.at(i), walks.start, grid, words);
}

/// Eight blocks beside each other along x, by layer and block.
struct EightBlocks {
  alignas(64) std::uint64_t words[8][8];
};

/// Byte `k` of each row goes to block `k`.
SPELUNK_WIDE_IF_POSSIBLE void split(const std::uint64_t* corner, std::size_t row_words,
                                    std::size_t layer_words, EightBlocks& __restrict blocks) {
  for (std::size_t z = 0; z < 8; ++z) {
    std::uint64_t layer[8] = {};
    for (unsigned y = 0; y < 8; ++y) {
      const std::uint64_t row = corner[z * layer_words + y * row_words];
      for (unsigned k = 0; k < 8; ++k) layer[k] |= ((row >> (8 * k)) & 0xFF) << (8 * y);
    }
    for (unsigned k = 0; k < 8; ++k) blocks.words[z][k] = layer[k];
  }
}

/// The blocks of eight by eight rows, at a word of x each.
void collectBlocks(const RayGrid& grid, const std::uint64_t* words, const VoxelIndex& block,
                   ScanMarks& marks) {
  const std::uint64_t* corner = words + static_cast<std::size_t>(block.z()) * 8 * grid.layer_words +
                                static_cast<std::size_t>(block.y()) * 8 * grid.row_words +
                                block.x();
  std::uint64_t any = 0;
  for (std::size_t z = 0; z < 8; ++z)
    for (std::size_t y = 0; y < 8; ++y) any |= corner[z * grid.layer_words + y * grid.row_words];
  if (any == 0) return;
  EightBlocks blocks;
  split(corner, grid.row_words, grid.layer_words, blocks);
  for (int x = 0; x < 8; ++x) {
    if (((any >> (8 * x)) & 0xFF) == 0) continue;
    const VoxelIndex first =
        grid.first + kBlockSide * VoxelIndex(8 * block.x() + x, block.y(), block.z());
    Mask& free = marks.block(marks.touch(packIndex(first))).free;
    for (std::size_t z = 0; z < 8; ++z) free[z] |= blocks.words[z][x];
  }
}

void walkOne(const RayWalk& walk, const VoxelIndex& start, ScanMarks& marks) {
  double next[3] = {walk.next[0], walk.next[1], walk.next[2]};
  VoxelIndex at = start;
  double limit = std::numeric_limits<double>::infinity();
  do {
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (next[axis] > limit) return;
    const PackedKey key = packIndex(at);
    marks.block(marks.touch(key)).free[static_cast<std::size_t>(wordOf(key))] |= std::uint64_t{1}
                                                                                 << bitOf(key);
    at(axis) += walk.step[axis];
    next[axis] += walk.spacing[axis];
    limit = walk.length;
  } while (at != walk.end);
}

}  // namespace

void RayWalks::resize(std::size_t rays) {
  count = rays;
  const std::size_t room = (rays + 7) / 8 * 8;
  if (length.size() >= room) return;
  for (int axis = 0; axis < 3; ++axis) {
    next[axis].resize(room);
    spacing[axis].resize(room);
    step[axis].resize(room);
    end[axis].resize(room);
  }
  length.resize(room);
}

void RayWalks::set(std::size_t i, const RayWalk& walk) {
  for (int axis = 0; axis < 3; ++axis) {
    next[axis][i] = walk.next[axis];
    spacing[axis][i] = walk.spacing[axis];
    step[axis][i] = walk.step[axis];
    end[axis][i] = walk.end(axis);
  }
  length[i] = walk.length;
}

RayWalk RayWalks::at(std::size_t i) const {
  RayWalk walk;
  for (int axis = 0; axis < 3; ++axis) {
    walk.next[axis] = next[axis][i];
    walk.spacing[axis] = spacing[axis][i];
    walk.step[axis] = step[axis][i];
    walk.end(axis) = end[axis][i];
  }
  walk.length = length[i];
  return walk;
}

RayMarker::RayMarker(WalkLanes lanes) : lanes_(lanes) {
  require(lanes == WalkLanes::kOne || hasEightLanes(),
          "RayMarker: this processor has no registers of eight lanes");
}

WalkLanes RayMarker::most() { return hasEightLanes() ? WalkLanes::kEight : WalkLanes::kOne; }

void RayMarker::markFreeOneByOne(const RayWalks& walks, ScanMarks& marks) {
  for (std::size_t i = 0; i < walks.count; ++i) walkOne(walks.at(i), walks.start, marks);
}

void RayMarker::markFree(const RayWalks& walks, ScanMarks& marks) {
  if (walks.count == 0) return;
  const RayGrid grid(walks);
  if (grid.words() > kWordsMax) return markFreeOneByOne(walks, marks);
  words_.assign(grid.words(), 0);
  walkThroughAll(walks, grid, lanes_, words_.data());
  for (int z = 0; z < grid.blocks.z(); ++z)
    for (int y = 0; y < grid.blocks.y(); ++y)
      for (int x = 0; x < grid.blocks.x() / 8; ++x)
        collectBlocks(grid, words_.data(), {x, y, z}, marks);
}

}  // namespace spelunk::map
