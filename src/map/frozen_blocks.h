#pragma once

#include <memory>
#include <vector>

#include "block_map.h"
#include "silent_voxels.h"
#include "spelunk/map/frozen_map.h"
#include "voxel_key.h"

namespace spelunk::map {

inline constexpr int kChunkSide = 32;

/// Status bits of one block; a row of eight voxels along x is one byte of a word.
struct StatusBlock {
  Mask known{};
  Mask occupied{};
  Mask silent{};  ///< Unknown voxels from which nothing returned; see OccupancyMap::watchSilence.
};

/// 4x4x4 blocks: what two snapshots share if nothing in it changed between them.
struct StatusChunk {
  PackedKey key = 0;  ///< Of its first voxel.
  std::array<StatusBlock, 64> blocks;

  static std::size_t slotOf(PackedKey voxel) {
    return static_cast<std::size_t>(((voxel >> 3) & 3) | ((voxel >> (kKeyFieldBits + 1)) & 12) |
                                    ((voxel >> (2 * kKeyFieldBits - 1)) & 48));
  }
};

struct FrozenMap::Blocks {
  std::vector<std::shared_ptr<const StatusChunk>> chunks;
  std::shared_ptr<const KeyTable> table = std::make_shared<KeyTable>();  ///< Chunk key to number.
  std::size_t free_voxels = 0;
  std::size_t occupied_voxels = 0;
  Extent known{VoxelIndex::Constant(1 << 30), VoxelIndex::Constant(-(1 << 30))};

  /// The block around a voxel of OctoMap's key range; nullptr where nothing was ever seen.
  [[nodiscard]] const StatusBlock* find(PackedKey voxel) const {
    const std::uint32_t number = table->find(voxel & ~kInChunkMask);
    if (number == KeyTable::kAbsent) return nullptr;
    return &chunks[number]->blocks[StatusChunk::slotOf(voxel)];
  }
};

/// Whether `now` is `before` or came from it by changes: chunks keep their number for life.
bool isLaterThan(const FrozenMap::Blocks& now, const FrozenMap::Blocks& before);

/// What changed since the last snapshot.
struct MapChanges {
  std::vector<std::uint32_t> status;  ///< Numbers of blocks.
  std::vector<PackedKey> silence;     ///< Keys of blocks.
  [[nodiscard]] bool empty() const { return status.empty() && silence.empty(); }
};

/// The next snapshot: shares every chunk of `last` in which nothing changed.
std::shared_ptr<const FrozenMap::Blocks> freezeBlocks(const BlockMap& map,
                                                      const SilentVoxels& silence,
                                                      const MapChanges& changed,
                                                      const FrozenMap::Blocks& last);

}  // namespace spelunk::map
