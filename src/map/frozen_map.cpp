#include "spelunk/map/frozen_map.h"

#include <algorithm>
#include <limits>

#include "frozen_blocks.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

/// Chunks being written for one snapshot; each is copied once.
class ChunkWriter {
 public:
  explicit ChunkWriter(FrozenMap::Blocks& blocks)
      : blocks_(blocks), writable_(blocks.chunks.size(), nullptr) {}

  StatusBlock& at(PackedKey voxel) {
    return chunkOf(voxel & ~kInChunkMask).blocks[StatusChunk::slotOf(voxel)];
  }

 private:
  StatusChunk& chunkOf(PackedKey key) {
    std::uint32_t number = blocks_.table->find(key);
    if (number == KeyTable::kAbsent) number = add(key);
    if (writable_[number] == nullptr) {
      auto copy = std::make_shared<StatusChunk>(*blocks_.chunks[number]);
      writable_[number] = copy.get();
      blocks_.chunks[number] = std::move(copy);
    }
    return *writable_[number];
  }

  std::uint32_t add(PackedKey key) {
    if (table_ == nullptr) {
      table_ = std::make_shared<KeyTable>(*blocks_.table);
      blocks_.table = table_;
    }
    const auto number = static_cast<std::uint32_t>(blocks_.chunks.size());
    auto chunk = std::make_shared<StatusChunk>();
    chunk->key = key;
    table_->insert(key, number);
    writable_.push_back(chunk.get());
    blocks_.chunks.push_back(std::move(chunk));
    return number;
  }

  FrozenMap::Blocks& blocks_;
  std::vector<StatusChunk*> writable_;
  std::shared_ptr<KeyTable> table_;
};

}  // namespace

std::shared_ptr<const FrozenMap::Blocks> freezeBlocks(const BlockMap& map,
                                                      const SilentVoxels& silence,
                                                      const MapChanges& changed,
                                                      const FrozenMap::Blocks& last) {
  auto next = std::make_shared<FrozenMap::Blocks>(last);
  ChunkWriter writer(*next);
  const auto silenceUnknown = [&](StatusBlock& status, PackedKey key) {
    status.silent = silence.silentIn(key);
    for (std::size_t z = 0; z < status.silent.size(); ++z) status.silent[z] &= ~status.known[z];
  };
  for (const std::uint32_t number : changed.status) {
    const VoxelBlock& block = map.block(number);
    StatusBlock& status = writer.at(block.key);
    status.known = block.known;
    status.occupied = block.occupied;
    silenceUnknown(status, block.key);
  }
  for (const PackedKey key : changed.silence) silenceUnknown(writer.at(key), key);
  next->free_voxels = map.freeVoxels();
  next->occupied_voxels = map.occupiedVoxels();
  next->known = map.knownExtent();
  return next;
}

bool isLaterThan(const FrozenMap::Blocks& now, const FrozenMap::Blocks& before) {
  if (now.chunks.size() < before.chunks.size()) return false;
  for (std::size_t i = 0; i < before.chunks.size(); ++i)
    if (now.chunks[i]->key != before.chunks[i]->key) return false;
  return true;
}

FrozenMap::FrozenMap(std::shared_ptr<const Blocks> blocks, double resolution_m)
    : blocks_(std::move(blocks)), resolution_m_(resolution_m) {
  require(blocks_ != nullptr, "FrozenMap: no blocks");
  require(std::isfinite(resolution_m) && resolution_m > 0.0, "FrozenMap: bad resolution");
}

VoxelIndex FrozenMap::indexOf(const Eigen::Vector3d& point) const {
  return voxelOf(point, 1.0 / resolution_m_);
}

Eigen::Vector3d FrozenMap::centreOf(const VoxelIndex& index) const {
  return (index.cast<double>().array() + 0.5) * resolution_m_;
}

bool FrozenMap::isSilent(const VoxelIndex& index) const {
  if (!isInKeyRange(index)) return false;
  const PackedKey key = packIndex(index);
  const StatusBlock* block = blocks_->find(key);
  return block != nullptr &&
         ((block->silent[static_cast<std::size_t>(wordOf(key))] >> bitOf(key)) & 1) != 0;
}

Occupancy FrozenMap::at(const VoxelIndex& index) const {
  if (!isInKeyRange(index)) return Occupancy::kUnknown;
  const PackedKey key = packIndex(index);
  const StatusBlock* block = blocks_->find(key);
  if (block == nullptr) return Occupancy::kUnknown;
  const auto word = static_cast<std::size_t>(wordOf(key));
  const int bit = bitOf(key);
  if (((block->known[word] >> bit) & 1) == 0) return Occupancy::kUnknown;
  return ((block->occupied[word] >> bit) & 1) != 0 ? Occupancy::kOccupied : Occupancy::kFree;
}

AxisAlignedBox FrozenMap::knownBounds() const {
  const Extent& known = blocks_->known;
  if ((known.min.array() > known.max.array()).any()) {
    const double infinity = std::numeric_limits<double>::infinity();
    return {Eigen::Vector3d::Constant(infinity), Eigen::Vector3d::Constant(-infinity)};
  }
  return {known.min.cast<double>() * resolution_m_,
          (known.max.array() + 1).cast<double>() * resolution_m_};
}

std::size_t FrozenMap::freeVoxels() const { return blocks_->free_voxels; }
std::size_t FrozenMap::occupiedVoxels() const { return blocks_->occupied_voxels; }

void FrozenMap::forEachOccupied(const AxisAlignedBox& region,
                                const std::function<void(const VoxelIndex&)>& visit) const {
  const Extent& known = blocks_->known;
  VoxelIndex first;
  VoxelIndex last;
  for (int axis = 0; axis < 3; ++axis) {
    const IndexRange range = centresIn(region.min(axis), region.max(axis), resolution_m_,
                                       {known.min(axis), known.max(axis)});
    if (range.first > range.last) return;
    first(axis) = range.first;
    last(axis) = range.last;
  }
  std::vector<const StatusChunk*> chunks;
  for (const auto& chunk : blocks_->chunks) {
    const VoxelIndex corner = unpackIndex(chunk->key);
    if ((corner.array() <= last.array()).all() && (corner.array() + 31 >= first.array()).all())
      chunks.push_back(chunk.get());
  }
  std::sort(chunks.begin(), chunks.end(),
            [](const StatusChunk* a, const StatusChunk* b) { return a->key < b->key; });
  for (const StatusChunk* chunk : chunks)
    for (int slot = 0; slot < 64; ++slot) {
      const VoxelIndex corner =
          unpackIndex(chunk->key) + 8 * VoxelIndex(slot & 3, (slot >> 2) & 3, slot >> 4);
      forEachVoxel(
          chunk->blocks[static_cast<std::size_t>(slot)].occupied, [&](const VoxelIndex& in_block) {
            const VoxelIndex voxel = corner + in_block;
            if ((voxel.array() >= first.array()).all() && (voxel.array() <= last.array()).all())
              visit(voxel);
          });
    }
}

}  // namespace spelunk::map
