#include "silent_voxels.h"

#include <algorithm>
#include <utility>

namespace spelunk::map {

SilentVoxels::Block& SilentVoxels::blockOf(PackedKey key) {
  const std::uint32_t found = table_.find(key);
  if (found != KeyTable::kAbsent) return blocks_[found];
  table_.insert(key, static_cast<std::uint32_t>(blocks_.size()));
  blocks_.emplace_back().key = key;
  return blocks_.back();
}

void SilentVoxels::countLook(std::vector<PackedKey> voxels) {
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  for (const PackedKey voxel : voxels) {
    Block& block = blockOf(voxel & ~kInBlockMask);
    std::uint64_t& low = block.low[static_cast<std::size_t>(wordOf(voxel))];
    std::uint64_t& high = block.high[static_cast<std::size_t>(wordOf(voxel))];
    const std::uint64_t bit = std::uint64_t{1} << bitOf(voxel);
    if ((low & high & bit) != 0) continue;
    high ^= low & bit;
    low ^= bit;
    const bool is_silent = (low & high & bit) != 0;
    if (!is_silent || std::exchange(block.is_listed, true)) continue;
    changes_.push_back(block.key);
  }
}

Mask SilentVoxels::silentIn(PackedKey voxel) const {
  const std::uint32_t number = table_.find(voxel & ~kInBlockMask);
  return number == KeyTable::kAbsent ? Mask{} : silentIn(blocks_[number]);
}

Mask SilentVoxels::silentIn(const Block& block) {
  Mask silent{};
  for (std::size_t z = 0; z < silent.size(); ++z) silent[z] = block.low[z] & block.high[z];
  return silent;
}

std::vector<PackedKey> SilentVoxels::all() const {
  std::vector<PackedKey> voxels;
  for (const Block& block : blocks_)
    forEachVoxel(silentIn(block), [&](const VoxelIndex& in_block) {
      voxels.push_back(block.key + packKey(in_block.x(), in_block.y(), in_block.z()));
    });
  return voxels;
}

std::vector<PackedKey> SilentVoxels::takeChanges() {
  for (const PackedKey key : changes_) blocks_[table_.find(key)].is_listed = false;
  return std::exchange(changes_, {});
}

std::size_t SilentVoxels::memoryBytes() const {
  return blocks_.capacity() * sizeof(Block) + table_.memoryBytes();
}

}  // namespace spelunk::map
