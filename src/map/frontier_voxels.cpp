#include "spelunk/map/frontier_voxels.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "frozen_blocks.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr std::uint64_t kLowX = 0x0101010101010101u;  // bits with x = 0 of each row
constexpr std::uint64_t kHighX = kLowX << 7;
constexpr std::uint64_t kLowY = 0xFFu;
constexpr std::uint64_t kHighY = kLowY << 56;

const Mask kNothing{};

const Mask& knownIn(const FrozenMap::Blocks& blocks, const VoxelIndex& corner) {
  if (!isInKeyRange(corner)) return kNothing;
  const StatusBlock* block = blocks.find(packIndex(corner));
  return block == nullptr ? kNothing : block->known;
}

/// The known voxels of a block and of the six around it.
struct Surroundings {
  const Mask& here;
  const Mask& left;
  const Mask& right;
  const Mask& front;
  const Mask& back;
  const Mask& below;
  const Mask& above;

  Surroundings(const FrozenMap::Blocks& blocks, const Mask& known, const VoxelIndex& corner)
      : here(known),
        left(knownIn(blocks, corner - kBlockSide * VoxelIndex::UnitX())),
        right(knownIn(blocks, corner + kBlockSide * VoxelIndex::UnitX())),
        front(knownIn(blocks, corner - kBlockSide * VoxelIndex::UnitY())),
        back(knownIn(blocks, corner + kBlockSide * VoxelIndex::UnitY())),
        below(knownIn(blocks, corner - kBlockSide * VoxelIndex::UnitZ())),
        above(knownIn(blocks, corner + kBlockSide * VoxelIndex::UnitZ())) {}

  /// Voxels of one layer all of whose six neighbours are known.
  [[nodiscard]] std::uint64_t enclosed(std::size_t z) const {
    const std::uint64_t row = here[z];
    const std::uint64_t on_left = ((row & ~kHighX) << 1) | ((left[z] & kHighX) >> 7);
    const std::uint64_t on_right = ((row & ~kLowX) >> 1) | ((right[z] & kLowX) << 7);
    const std::uint64_t in_front = (row << 8) | (front[z] >> 56);
    const std::uint64_t in_back = (row >> 8) | (back[z] << 56);
    const std::uint64_t under = z == 0 ? below[kBlockSide - 1] : here[z - 1];
    const std::uint64_t over = z + 1 == kBlockSide ? above[0] : here[z + 1];
    return on_left & on_right & in_front & in_back & under & over;
  }
};

/// Blocks to be looked at again, one bit a block of each chunk.
class DirtyBlocks {
 public:
  explicit DirtyBlocks(const FrozenMap::Blocks& blocks)
      : blocks_(blocks), slots_(blocks.chunks.size(), 0) {}

  /// Marks what differs between two states of a chunk, and what looks at it from beside.
  void addChanges(std::size_t number, const StatusChunk& now, const StatusChunk* before) {
    static const StatusBlock kUnseen;
    for (std::size_t slot = 0; slot < now.blocks.size(); ++slot) {
      const StatusBlock& old = before == nullptr ? kUnseen : before->blocks[slot];
      const StatusBlock& block = now.blocks[slot];
      if (block.known == old.known && block.occupied == old.occupied) continue;
      slots_[number] |= std::uint64_t{1} << slot;
      addNeighbours(cornerOf(now.key, slot), old.known, block.known);
    }
  }
  [[nodiscard]] std::uint64_t slotsOf(std::size_t number) const { return slots_[number]; }

  static VoxelIndex cornerOf(PackedKey chunk, std::size_t slot) {
    const int s = static_cast<int>(slot);
    return unpackIndex(chunk) + kBlockSide * VoxelIndex(s & 3, (s >> 2) & 3, s >> 4);
  }

 private:
  void addNeighbours(const VoxelIndex& corner, const Mask& old, const Mask& known) {
    std::uint64_t any = 0;
    for (std::size_t z = 0; z < old.size(); ++z) any |= old[z] ^ known[z];
    if ((any & kLowX) != 0) add(corner - kBlockSide * VoxelIndex::UnitX());
    if ((any & kHighX) != 0) add(corner + kBlockSide * VoxelIndex::UnitX());
    if ((any & kLowY) != 0) add(corner - kBlockSide * VoxelIndex::UnitY());
    if ((any & kHighY) != 0) add(corner + kBlockSide * VoxelIndex::UnitY());
    if (old.front() != known.front()) add(corner - kBlockSide * VoxelIndex::UnitZ());
    if (old.back() != known.back()) add(corner + kBlockSide * VoxelIndex::UnitZ());
  }
  void add(const VoxelIndex& corner) {
    if (!isInKeyRange(corner)) return;
    const PackedKey key = packIndex(corner);
    const std::uint32_t number = blocks_.table->find(key & ~kInChunkMask);
    if (number != KeyTable::kAbsent) slots_[number] |= std::uint64_t{1} << StatusChunk::slotOf(key);
  }

  const FrozenMap::Blocks& blocks_;
  std::vector<std::uint64_t> slots_;
};

std::size_t countOf(const Mask& mask) {
  std::size_t count = 0;
  for (const std::uint64_t word : mask)
    count += static_cast<std::size_t>(__builtin_popcountll(word));
  return count;
}

/// Calls `visit` for the voxels of a block's mask that lie between two corners.
template <class Visit>
void forEachVoxelWithin(const Mask& mask, const VoxelIndex& corner, const VoxelIndex& first,
                        const VoxelIndex& last, Visit&& visit) {
  forEachVoxel(mask, [&](const VoxelIndex& in_block) {
    const VoxelIndex voxel = corner + in_block;
    if ((voxel.array() >= first.array()).all() && (voxel.array() <= last.array()).all())
      visit(voxel);
  });
}

int floorToChunk(int index) { return index & ~(kChunkSide - 1); }

}  // namespace

struct FrontierVoxels::Chunk {
  std::array<Mask, 64> blocks{};
  std::array<std::uint16_t, 64> counts{};
  std::uint64_t last_change = 0;
};

void FrontierVoxels::update(std::shared_ptr<const FrozenMap> map) {
  require(map != nullptr, "FrontierVoxels: no map");
  if (map == map_) return;
  const FrozenMap::Blocks nothing;
  const bool goes_on = map_ != nullptr && map_->resolution() == map->resolution() &&
                       isLaterThan(map->blocks(), map_->blocks());
  if (!goes_on) {
    chunks_.clear();
    count_ = 0;
  }
  const std::shared_ptr<const FrozenMap> last = std::exchange(map_, std::move(map));
  const FrozenMap::Blocks& now = map_->blocks();
  const FrozenMap::Blocks& before = goes_on ? last->blocks() : nothing;
  ++updates_;
  DirtyBlocks dirty(now);
  for (std::size_t i = 0; i < now.chunks.size(); ++i) {
    const StatusChunk* old = i < before.chunks.size() ? before.chunks[i].get() : nullptr;
    if (old != now.chunks[i].get()) dirty.addChanges(i, *now.chunks[i], old);
  }
  while (chunks_.size() < now.chunks.size()) chunks_.push_back(std::make_shared<Chunk>());
  for (std::size_t i = 0; i < chunks_.size(); ++i)
    if (dirty.slotsOf(i) != 0) recompute(i, dirty.slotsOf(i));
}

void FrontierVoxels::recompute(std::size_t number, std::uint64_t slots) {
  const FrozenMap::Blocks& blocks = map_->blocks();
  const StatusChunk& source = *blocks.chunks[number];
  Chunk& chunk = *chunks_[number];
  for (; slots != 0; slots &= slots - 1) {
    const auto slot = static_cast<std::size_t>(__builtin_ctzll(slots));
    const StatusBlock& block = source.blocks[slot];
    const Surroundings around(blocks, block.known, DirtyBlocks::cornerOf(source.key, slot));
    Mask frontier;
    for (std::size_t z = 0; z < frontier.size(); ++z)
      frontier[z] = block.known[z] & ~block.occupied[z] & ~around.enclosed(z);
    if (frontier == chunk.blocks[slot]) continue;
    const std::size_t count = countOf(frontier);
    count_ += count - chunk.counts[slot];
    chunk.counts[slot] = static_cast<std::uint16_t>(count);
    chunk.blocks[slot] = frontier;
    chunk.last_change = updates_;
  }
}

template <class Visit>
void FrontierVoxels::forEachChunkIn(const VoxelIndex& first, const VoxelIndex& last,
                                    Visit&& visit) const {
  for (int z = floorToChunk(first.z()); z <= last.z(); z += kChunkSide)
    for (int y = floorToChunk(first.y()); y <= last.y(); y += kChunkSide)
      for (int x = floorToChunk(first.x()); x <= last.x(); x += kChunkSide) {
        const VoxelIndex corner(x, y, z);
        if (!isInKeyRange(corner)) continue;
        const std::uint32_t number = map_->blocks().table->find(packIndex(corner));
        if (number != KeyTable::kAbsent) visit(*chunks_[number], corner);
      }
}

template <class Visit>
void FrontierVoxels::forEachBlockIn(const AxisAlignedBox& region, Visit&& visit) const {
  if (map_ == nullptr) return;
  const Extent& known = map_->blocks().known;
  VoxelIndex first;
  VoxelIndex last;
  for (int axis = 0; axis < 3; ++axis) {
    if (known.min(axis) > known.max(axis)) return;
    const IndexRange range = centresIn(region.min(axis), region.max(axis), map_->resolution(),
                                       {known.min(axis), known.max(axis)});
    if (range.first > range.last) return;
    first(axis) = range.first;
    last(axis) = range.last;
  }
  forEachChunkIn(first, last, [&](const Chunk& chunk, const VoxelIndex& chunk_corner) {
    for (std::size_t slot = 0; slot < chunk.blocks.size(); ++slot) {
      if (chunk.counts[slot] == 0) continue;
      const VoxelIndex corner = DirtyBlocks::cornerOf(packIndex(chunk_corner), slot);
      if ((corner.array() > last.array()).any() ||
          (corner.array() + (kBlockSide - 1) < first.array()).any())
        continue;
      visit(chunk.blocks[slot], corner, first, last);
    }
  });
}

bool FrontierVoxels::contains(const VoxelIndex& index) const {
  if (map_ == nullptr || !isInKeyRange(index)) return false;
  const PackedKey key = packIndex(index);
  const std::uint32_t number = map_->blocks().table->find(key & ~kInChunkMask);
  if (number == KeyTable::kAbsent) return false;
  const Mask& mask = chunks_[number]->blocks[StatusChunk::slotOf(key)];
  return ((mask[static_cast<std::size_t>(wordOf(key))] >> bitOf(key)) & 1) != 0;
}

std::vector<VoxelIndex> FrontierVoxels::within(const AxisAlignedBox& region) const {
  std::vector<VoxelIndex> voxels;
  forEachBlockIn(region, [&](const Mask& mask, const VoxelIndex& corner, const VoxelIndex& first,
                             const VoxelIndex& last) {
    forEachVoxelWithin(mask, corner, first, last,
                       [&](const VoxelIndex& v) { voxels.push_back(v); });
  });
  return voxels;
}

std::size_t FrontierVoxels::countWithin(const AxisAlignedBox& region) const {
  std::size_t count = 0;
  forEachBlockIn(region, [&](const Mask& mask, const VoxelIndex& corner, const VoxelIndex& first,
                             const VoxelIndex& last) {
    forEachVoxelWithin(mask, corner, first, last, [&](const VoxelIndex&) { ++count; });
  });
  return count;
}

std::vector<VoxelIndex> FrontierVoxels::all() const { return within(AxisAlignedBox{}); }

std::uint64_t FrontierVoxels::lastChangeNear(const AxisAlignedBox& region) const {
  if (map_ == nullptr) return 0;
  std::uint64_t last_change = 0;
  const AxisAlignedBox known = map_->knownBounds();
  const AxisAlignedBox part = known.isEmpty() ? known : intersection(region, known);
  if (part.isEmpty()) return 0;
  forEachChunkIn(map_->indexOf(part.min), map_->indexOf(part.max),
                 [&](const Chunk& chunk, const VoxelIndex&) {
                   last_change = std::max(last_change, chunk.last_change);
                 });
  return last_change;
}

}  // namespace spelunk::map
