#include "spelunk/map/local_window.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <vector>

#include "frozen_blocks.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

/// Spreads the bits of a byte to the lowest bits of eight bytes, first bit first in memory.
constexpr std::array<std::uint64_t, 256> spreadTable() {
  std::array<std::uint64_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte)
    for (unsigned bit = 0; bit < 8; ++bit)
      if (((byte >> bit) & 1) != 0) table[byte] |= std::uint64_t{1} << (8 * bit);
  return table;
}
constexpr std::array<std::uint64_t, 256> kSpread = spreadTable();

/// Bit `x` of byte `z` becomes bit `z` of byte `x`.
std::uint64_t transposed(std::uint64_t bits) {
  const auto swap = [&bits](int distance, std::uint64_t low) {
    const std::uint64_t differing = (bits ^ (bits >> distance)) & low;
    bits ^= differing ^ (differing << distance);
  };
  swap(7, 0x00AA00AA00AA00AAu);
  swap(14, 0x0000CCCC0000CCCCu);
  swap(28, 0x00000000F0F0F0F0u);
  return bits;
}

/// The columns along z over row `y` of a block: a byte each.
std::uint64_t columnsOf(const Mask& mask, int y) {
  std::uint64_t rows = 0;
  for (unsigned z = 0; z < kBlockSide; ++z) rows |= ((mask[z] >> (8 * y)) & 0xFF) << (8 * z);
  return transposed(rows);
}

const StatusChunk kUnknownChunk{};

/// Copies a block's voxels that lie in the window; known + occupied is the status.
class BlockCopier {
 public:
  BlockCopier(const VoxelIndex& origin, const VoxelIndex& size, std::uint8_t* cells)
      : origin_(origin), size_(size), cells_(cells) {}

  /// `before`: what the cells hold so far.
  void copy(const StatusBlock& block, const StatusBlock& before, const VoxelIndex& corner) {
    if (block.known == before.known && block.occupied == before.occupied) return;
    const bool was_unknown = before.known == Mask{};
    if (block.known != Mask{}) {
      known_.min = known_.min.cwiseMin(corner);
      known_.max = known_.max.cwiseMax(corner + VoxelIndex::Constant(kBlockSide - 1));
    }
    const VoxelIndex at = corner - origin_;
    const VoxelIndex first = (-at).cwiseMax(0);
    const VoxelIndex end = (size_ - at).cwiseMin(kBlockSide);
    for (int y = first.y(); y < end.y(); ++y) {
      const std::uint64_t known = columnsOf(block.known, y);
      const std::uint64_t occupied = columnsOf(block.occupied, y);
      if (known == 0 && was_unknown) continue;
      for (int x = first.x(); x < end.x(); ++x) {
        const std::size_t cell = offsetOf(at.x() + x, at.y() + y, at.z() + first.z());
        copyColumn((known >> (8 * x)) & 0xFF, (occupied >> (8 * x)) & 0xFF, first.z(), end.z(),
                   cell);
      }
    }
  }

  /// Around the blocks that hold something known.
  [[nodiscard]] const Extent& known() const { return known_; }

 private:
  /// Voxels first..end-1 of a column of eight, to `cell` and on.
  void copyColumn(std::uint64_t known, std::uint64_t occupied, int first, int end,
                  std::size_t cell) {
    const std::uint64_t column = kSpread[known] + kSpread[occupied];
    std::uint8_t bytes[kBlockSide];
    std::memcpy(bytes, &column, sizeof(bytes));
    if (end - first == kBlockSide)
      std::memcpy(cells_ + cell, bytes, kBlockSide);
    else
      std::copy(bytes + first, bytes + end, cells_ + cell);
  }
  [[nodiscard]] std::size_t offsetOf(int x, int y, int z) const {
    return static_cast<std::size_t>(z) +
           static_cast<std::size_t>(size_.z()) *
               (static_cast<std::size_t>(x) +
                static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(y));
  }

  VoxelIndex origin_;
  VoxelIndex size_;
  std::uint8_t* cells_;
  Extent known_{VoxelIndex::Constant(1 << 30), VoxelIndex::Constant(-(1 << 30))};
};

/// The chunks that hold a voxel of first..last, in no certain order.
std::vector<const StatusChunk*> chunksIn(const FrozenMap::Blocks& blocks, const VoxelIndex& first,
                                         const VoxelIndex& last) {
  const auto corner = [](const VoxelIndex& index) {
    return VoxelIndex(index.unaryExpr([](int i) { return i & ~(kChunkSide - 1); }));
  };
  const VoxelIndex low = corner(first.cwiseMax(-kKeyOffset));
  const VoxelIndex high = corner(last.cwiseMin(kKeyOffset - 1));
  std::vector<const StatusChunk*> found;
  const Eigen::Vector3d counts = (high - low).cast<double>() / kChunkSide;
  if ((counts.array() + 1.0).prod() > static_cast<double>(blocks.chunks.size())) {
    for (const auto& chunk : blocks.chunks) {
      const VoxelIndex at = unpackIndex(chunk->key);
      if ((at.array() >= low.array()).all() && (at.array() <= high.array()).all())
        found.push_back(chunk.get());
    }
    return found;
  }
  for (int z = low.z(); z <= high.z(); z += kChunkSide)
    for (int y = low.y(); y <= high.y(); y += kChunkSide)
      for (int x = low.x(); x <= high.x(); x += kChunkSide) {
        const std::uint32_t number = blocks.table->find(packIndex({x, y, z}));
        if (number != KeyTable::kAbsent) found.push_back(blocks.chunks[number].get());
      }
  return found;
}

/// `before`: the chunk as the window has it.
void copyChunk(const StatusChunk& chunk, const StatusChunk& before, const VoxelIndex& first,
               const VoxelIndex& last, BlockCopier& copier) {
  const VoxelIndex corner = unpackIndex(chunk.key);
  for (int slot = 0; slot < 64; ++slot) {
    const VoxelIndex at = corner + 8 * VoxelIndex(slot & 3, (slot >> 2) & 3, slot >> 4);
    if ((at.array() > last.array()).any() || (at.array() + 7 < first.array()).any()) continue;
    const auto i = static_cast<std::size_t>(slot);
    copier.copy(chunk.blocks[i], before.blocks[i], at);
  }
}

}  // namespace

LocalWindow::LocalWindow(const FrozenMap& map, const AxisAlignedBox& region)
    : resolution_m_(map.resolution()) {
  require(region.min.allFinite() && region.max.allFinite(), "LocalWindow: region is not finite");
  require(!region.isEmpty(), "LocalWindow: region is empty");
  origin_ = map.indexOf(region.min);
  const VoxelIndex last = map.indexOf(region.max);
  const Eigen::Vector3d size = last.cast<double>().array() - origin_.cast<double>().array() + 1.0;
  require(size.prod() < 2147483648.0, "LocalWindow: region has more than 2^31 voxels");
  size_ = last - origin_ + VoxelIndex::Ones();
  column_cells_ = static_cast<std::size_t>(size_.z());
  plane_cells_ = column_cells_ * static_cast<std::size_t>(size_.x());
  cell_count_ = static_cast<std::size_t>(size.prod());
  cells_.reset(static_cast<std::uint8_t*>(std::calloc(cell_count_, 1)));
  if (cells_ == nullptr) throw std::bad_alloc();
  BlockCopier copier(origin_, size_, cells_.get());
  for (const StatusChunk* chunk : chunksIn(map.blocks(), origin_, last))
    copyChunk(*chunk, kUnknownChunk, origin_, last, copier);
  known_first_ = copier.known().min;
  known_last_ = copier.known().max;
}

void LocalWindow::update(const FrozenMap& before, const FrozenMap& now) {
  const auto& old_chunks = before.blocks().chunks;
  const auto& chunks = now.blocks().chunks;
  if (before.resolution() != now.resolution() || !isLaterThan(now.blocks(), before.blocks())) {
    const Eigen::Vector3d half_voxel = Eigen::Vector3d::Constant(0.5 * resolution_m_);
    const AxisAlignedBox box = region();
    *this = LocalWindow(now, {box.min + half_voxel, box.max - half_voxel});
    return;
  }
  const VoxelIndex last = origin_ + size_ - VoxelIndex::Ones();
  BlockCopier copier(origin_, size_, cells_.get());
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (i < old_chunks.size() && old_chunks[i] == chunks[i]) continue;
    const VoxelIndex corner = unpackIndex(chunks[i]->key);
    const bool is_outside = (corner.array() > last.array()).any() ||
                            (corner.array() + kChunkSide <= origin_.array()).any();
    const StatusChunk& old_chunk = i < old_chunks.size() ? *old_chunks[i] : kUnknownChunk;
    if (!is_outside) copyChunk(*chunks[i], old_chunk, origin_, last, copier);
  }
  known_first_ = known_first_.cwiseMin(copier.known().min);
  known_last_ = known_last_.cwiseMax(copier.known().max);
}

VoxelIndex LocalWindow::indexOf(const Eigen::Vector3d& point) const {
  return voxelOf(point, 1.0 / resolution_m_);
}

Eigen::Vector3d LocalWindow::centreOf(const VoxelIndex& index) const {
  return (index.cast<double>().array() + 0.5) * resolution_m_;
}

AxisAlignedBox LocalWindow::region() const {
  return {origin_.cast<double>() * resolution_m_, (origin_ + size_).cast<double>() * resolution_m_};
}

}  // namespace spelunk::map
