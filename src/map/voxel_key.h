#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "spelunk/map/occupancy.h"

namespace spelunk::map {

/// A voxel in one word: OctoMap's key (index + 32768) of each axis in a field of 21 bits.
using PackedKey = std::uint64_t;

inline constexpr int kKeyOffset = 32768;
inline constexpr int kKeyFieldBits = 21;
inline constexpr int kBlockSide = 8;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;
inline constexpr PackedKey kFieldOnes = 1 | PackedKey{1} << 21 | PackedKey{1} << 42;
inline constexpr PackedKey kInBlockMask = 7 * kFieldOnes;   ///< Low three bits of each axis.
inline constexpr PackedKey kInChunkMask = 31 * kFieldOnes;  ///< Four blocks on each axis.

inline PackedKey packKey(int x, int y, int z) {
  return static_cast<PackedKey>(x) | static_cast<PackedKey>(y) << kKeyFieldBits |
         static_cast<PackedKey>(z) << (2 * kKeyFieldBits);
}

inline PackedKey packIndex(int x, int y, int z) {
  return packKey(x + kKeyOffset, y + kKeyOffset, z + kKeyOffset);
}

inline PackedKey packIndex(const VoxelIndex& index) {
  return packIndex(index.x(), index.y(), index.z());
}

inline VoxelIndex unpackIndex(PackedKey key) {
  const auto field = [key](int axis) {
    return static_cast<int>((key >> (axis * kKeyFieldBits)) & 0xFFFF) - kKeyOffset;
  };
  return {field(0), field(1), field(2)};
}

/// Coordinates below it in amount have a key, and so has a block around them: rounding may lead a
/// ray one voxel too far.
inline double keyLimit(double resolution) { return (kKeyOffset - kBlockSide) * resolution; }

/// Whether OctoMap has a key for the index.
inline bool isInKeyRange(const VoxelIndex& index) {
  return (index.array() >= -kKeyOffset).all() && (index.array() < kKeyOffset).all();
}

/// Position inside the block, x fastest: z is the word of a mask, y * 8 + x the bit.
inline int wordOf(PackedKey key) { return static_cast<int>((key >> (2 * kKeyFieldBits)) & 7); }
inline int bitOf(PackedKey key) {
  return static_cast<int>((key & 7) | ((key >> (kKeyFieldBits - 3)) & 56));
}

/// floor(coordinate / resolution) as OctoMap computes it, clamped so that no coordinate (infinite
/// or not a number included) overflows.
inline int voxelOf(double coordinate, double inverse_resolution) {
  constexpr double kLimit = 1 << 30;
  const double scaled = coordinate * inverse_resolution;
  if (!(scaled < kLimit)) return 1 << 30;
  if (scaled < -kLimit) return -(1 << 30);
  const int towards_zero = static_cast<int>(scaled);
  return towards_zero - (scaled < towards_zero ? 1 : 0);
}

inline VoxelIndex voxelOf(const Eigen::Vector3d& point, double inverse_resolution) {
  return {voxelOf(point.x(), inverse_resolution), voxelOf(point.y(), inverse_resolution),
          voxelOf(point.z(), inverse_resolution)};
}

/// Indices first..last; empty if last < first.
struct IndexRange {
  int first;
  int last;
};

/// The indices of `limits` whose voxel centres lie in the closed interval [min, max], which may be
/// infinite.
IndexRange centresIn(double min, double max, double resolution, IndexRange limits);

/// One bit a voxel of a block.
using Mask = std::array<std::uint64_t, kBlockSide>;

/// Calls `visit` with the index within the block of every voxel whose bit is set, z slowest.
template <class Visit>
void forEachVoxel(const Mask& mask, Visit&& visit) {
  for (int z = 0; z < kBlockSide; ++z)
    for (std::uint64_t bits = mask[static_cast<std::size_t>(z)]; bits != 0; bits &= bits - 1) {
      const int bit = __builtin_ctzll(bits);
      visit(VoxelIndex(bit & 7, bit >> 3, z));
    }
}

/// Hash table from packed keys to small numbers; never iterated, so no order can leak out of it.
class KeyTable {
 public:
  static constexpr std::uint32_t kAbsent = 0xFFFFFFFF;

  explicit KeyTable(int log2_size = 10) { reset(log2_size); }

  [[nodiscard]] std::uint32_t find(PackedKey key) const {
    std::size_t slot = slotOf(key);
    while (slots_[slot].key != key) {
      if (slots_[slot].key == kEmpty) return kAbsent;
      slot = (slot + 1) & mask_;
    }
    return slots_[slot].value;
  }

  /// The key must be absent.
  void insert(PackedKey key, std::uint32_t value) {
    if (2 * ++count_ > slots_.size()) grow();
    place(key, value);
  }

  void clear() { reset(kFullShift - shift_); }
  [[nodiscard]] std::size_t memoryBytes() const { return slots_.capacity() * sizeof(Slot); }

 private:
  struct Slot {
    PackedKey key;
    std::uint32_t value;
  };
  static constexpr PackedKey kEmpty = ~PackedKey{0};
  static constexpr int kFullShift = 64;

  [[nodiscard]] std::size_t slotOf(PackedKey key) const {
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> shift_);
  }
  void reset(int log2_size) {
    shift_ = kFullShift - log2_size;
    mask_ = (std::size_t{1} << log2_size) - 1;
    count_ = 0;
    slots_.assign(mask_ + 1, Slot{kEmpty, 0});
  }
  void place(PackedKey key, std::uint32_t value) {
    std::size_t slot = slotOf(key);
    while (slots_[slot].key != kEmpty) slot = (slot + 1) & mask_;
    slots_[slot] = {key, value};
  }
  void grow() {
    const std::vector<Slot> old = std::move(slots_);
    const std::size_t count = count_;
    reset(kFullShift - shift_ + 1);
    count_ = count;
    for (const Slot& slot : old)
      if (slot.key != kEmpty) place(slot.key, slot.value);
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::size_t count_ = 0;
  int shift_ = kFullShift;
};

/// The voxels of a block around all set bits of a mask that has some, relative to the block.
struct Extent {
  VoxelIndex min;
  VoxelIndex max;
};
Extent extentOf(const Mask& mask);

}  // namespace spelunk::map
