#include "octree_mirror.h"

#include <algorithm>
#include <limits>

namespace spelunk::map {
namespace {

constexpr unsigned kBlockDepth = 13;  // 16 levels, the last three lie inside a block

/// Offset of an octant in a block's array; OctoMap's child bits are x, y, z from the lowest.
int octantOffset(unsigned child, int side) {
  const int x = static_cast<int>(child & 1);
  const int y = static_cast<int>((child >> 1) & 1);
  const int z = static_cast<int>(child >> 2);
  return side * (x + 8 * y + 64 * z);
}

/// Bits of a cube in one word of a mask: `side` rows of `side` bits from bit 0.
std::uint64_t cubeBits(int side) {
  if (side == 8) return ~std::uint64_t{0};
  return side == 4 ? 0x0F0F0F0Fu : side == 2 ? 0x0303u : 1u;
}

bool isAnySet(const Mask& mask, int first, int side) {
  const std::uint64_t bits = cubeBits(side) << (first & 63);
  std::uint64_t found = 0;
  for (int z = 0; z < side; ++z) found |= mask[static_cast<std::size_t>((first >> 6) + z)] & bits;
  return found != 0;
}

bool areAllSet(const Mask& mask, int first, int side) {
  const std::uint64_t bits = cubeBits(side) << (first & 63);
  std::uint64_t found = bits;
  for (int z = 0; z < side; ++z) found &= mask[static_cast<std::size_t>((first >> 6) + z)];
  return found == bits;
}

}  // namespace

struct OcTreeMirror::Source {
  const VoxelBlock& block;
  const std::array<float, kBlockVoxels>& values;
  const Mask& wanted;

  /// Whether the cube is fully known and of one value, hence one pruned leaf.
  [[nodiscard]] bool isUniform(int first, int side) const {
    const float value = values[static_cast<std::size_t>(first)];
    if (values[static_cast<std::size_t>(first + 1)] != value) return false;
    if (!areAllSet(block.known, first, side)) return false;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          if (values[static_cast<std::size_t>(first + x + 8 * y + 64 * z)] != value) return false;
    return true;
  }
};

OcTreeMirror::OcTreeMirror(const MapParams& params) : octomap::OcTree(params.resolution_m) {
  setProbHit(params.hit_probability);
  setProbMiss(params.miss_probability);
  setClampingThresMin(params.clamp_min_probability);
  setClampingThresMax(params.clamp_max_probability);
  setOccupancyThres(params.occupied_probability);
}

void OcTreeMirror::update(const VoxelBlock& block) {
  enter({block, block.log_odds, block.tree_stale});
}

void OcTreeMirror::updateMaximumLikelihood(const VoxelBlock& block) {
  std::array<float, kBlockVoxels> values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = ((block.occupied[i >> 6] >> (i & 63)) & 1) != 0 ? getClampingThresMaxLog()
                                                                : getClampingThresMinLog();
  enter({block, values, block.known});
}

void OcTreeMirror::enter(const Source& source) {
  if (!isAnySet(source.wanted, 0, kBlockSide)) return;
  bool is_new = false;
  if (root == nullptr) {
    root = new octomap::OcTreeNode();  // the base class owns and deletes it
    ++tree_size;
    is_new = true;
  }
  descend(root, is_new, 0, source);
  size_changed = true;
}

octomap::OcTreeNode* OcTreeMirror::childFor(octomap::OcTreeNode* node, unsigned child,
                                            bool& is_new) {
  const bool is_node_new = is_new;
  is_new = false;
  if (nodeChildExists(node, child)) return getNodeChild(node, child);
  if (!is_node_new && !nodeHasChildren(node)) {
    expandNode(node);  // a pruned leaf
    return getNodeChild(node, child);
  }
  is_new = true;
  return createNodeChild(node, child);
}

void OcTreeMirror::descend(octomap::OcTreeNode* node, bool is_new, unsigned depth,
                           const Source& source) {
  if (depth == kBlockDepth) {
    fillCube(node, is_new, 0, kBlockSide, source);
    return;
  }
  const unsigned level = 15 - depth;
  const auto bit = [&](int axis) {
    return static_cast<unsigned>((source.block.key >> (axis * kKeyFieldBits)) >> level) & 1U;
  };
  const unsigned child = bit(0) | bit(1) << 1 | bit(2) << 2;
  octomap::OcTreeNode* next = childFor(node, child, is_new);
  descend(next, is_new, depth + 1, source);
  finish(node);
}

void OcTreeMirror::fillCube(octomap::OcTreeNode* node, bool is_new, int first_voxel, int side,
                            const Source& source) {
  if (source.isUniform(first_voxel, side)) {
    collapse(node, source.values[static_cast<std::size_t>(first_voxel)]);
    return;
  }
  // What was one pruned leaf gets all its children anew; the block knows their values.
  if (!is_new && !nodeHasChildren(node)) {
    fillChildren(node, first_voxel, side, {source.block, source.values, source.block.known});
    return;
  }
  fillChildren(node, first_voxel, side, source);
}

void OcTreeMirror::fillChildren(octomap::OcTreeNode* node, int first_voxel, int side,
                                const Source& source) {
  const int half = side / 2;
  float highest = -std::numeric_limits<float>::max();
  for (unsigned child = 0; child < 8; ++child) {
    const int first = first_voxel + octantOffset(child, half);
    const bool is_new = !nodeChildExists(node, child);
    const bool is_wanted = isAnySet(source.wanted, first, half);
    if (is_new && !is_wanted) continue;
    octomap::OcTreeNode* next = is_new ? createNodeChild(node, child) : getNodeChild(node, child);
    if (is_wanted && half == 1)
      next->setLogOdds(source.values[static_cast<std::size_t>(first)]);
    else if (is_wanted)
      fillCube(next, is_new, first, half, source);
    highest = std::max(highest, next->getLogOdds());
  }
  node->setLogOdds(highest);  // inner nodes hold the maximum of their children
}

void OcTreeMirror::collapse(octomap::OcTreeNode* node, float value) {
  if (nodeHasChildren(node)) {
    // Only pruneNode can free the array of children, and it wants eight equal ones.
    for (unsigned child = 0; child < 8; ++child)
      collapse(
          nodeChildExists(node, child) ? getNodeChild(node, child) : createNodeChild(node, child),
          value);
    pruneNode(node);
  }
  node->setLogOdds(value);
}

void OcTreeMirror::finish(octomap::OcTreeNode* node) {
  if (!pruneNode(node)) node->updateOccupancyChildren();
}

}  // namespace spelunk::map
