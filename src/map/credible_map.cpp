#include "spelunk/map/credible_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "frozen_blocks.h"
#include "spelunk/common/contract.h"
#include "spelunk/common/wide_loops.h"

namespace spelunk::map {
namespace {

constexpr int kHalo = kBlockSide;  ///< Voxels around a chunk that are looked at in x and y.
constexpr int kRows = kChunkSide + 2 * kHalo;
constexpr int kGapMax = 30;
constexpr int kGrowthMax = kHalo - 1;

/// A chunk and what lies around it, one bit a voxel: a word is a row along x, a layer is one
/// height.
class Rows {
 public:
  explicit Rows(int layers)
      : layers_(layers), words_(static_cast<std::size_t>(layers) * kRows, 0) {}

  [[nodiscard]] int layers() const { return layers_; }
  [[nodiscard]] std::uint64_t& at(int y, int z) { return words_[offset(y, z)]; }
  [[nodiscard]] std::uint64_t at(int y, int z) const { return words_[offset(y, z)]; }
  [[nodiscard]] std::uint64_t* layer(int z) { return words_.data() + offset(0, z); }
  [[nodiscard]] const std::uint64_t* layer(int z) const { return words_.data() + offset(0, z); }
  [[nodiscard]] bool isEmpty() const {
    return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
  }
  void clear() { std::fill(words_.begin(), words_.end(), 0); }

 private:
  static std::size_t offset(int y, int z) {
    return static_cast<std::size_t>(z) * kRows + static_cast<std::size_t>(y);
  }
  int layers_;
  std::vector<std::uint64_t> words_;
};

/// Each layer becomes the union of itself and the `length` - 1 below it.
SPELUNK_WIDE_IF_POSSIBLE void spreadUp(Rows& rows, int length) {
  for (int done = 1; done < length;) {
    const int shift = std::min(done, length - done);
    for (int z = rows.layers() - 1; z >= shift; --z) {
      std::uint64_t* layer = rows.layer(z);
      const std::uint64_t* below = rows.layer(z - shift);
      for (int y = 0; y < kRows; ++y) layer[y] |= below[y];
    }
    done += shift;
  }
}

/// Each layer becomes the intersection of itself and the `length` - 1 above it; no bits above all.
SPELUNK_WIDE_IF_POSSIBLE void shrinkDown(Rows& rows, int length) {
  for (int done = 1; done < length;) {
    const int shift = std::min(done, length - done);
    const int kept = std::max(0, rows.layers() - shift);
    for (int z = 0; z < kept; ++z) {
      std::uint64_t* layer = rows.layer(z);
      const std::uint64_t* above = rows.layer(z + shift);
      for (int y = 0; y < kRows; ++y) layer[y] &= above[y];
    }
    for (int z = kept; z < rows.layers(); ++z) std::fill_n(rows.layer(z), kRows, 0);
    done += shift;
  }
}

/// From how far in its surroundings a chunk is computed, in blocks.
struct Halo {
  int sideways;
  int upwards;
};

/// Works on the surroundings of one chunk at a time.
class ChunkFilter {
 public:
  ChunkFilter(int gap, int reach)
      : gap_(gap),
        reach_(reach),
        halo_(kBlockSide * ((gap + 2 + kBlockSide - 1) / kBlockSide)),
        free_(kChunkSide + 2 * halo_),
        occupied_(free_.layers()),
        gaps_(free_.layers()),
        wide_(free_.layers()),
        silent_(free_.layers()) {}

  [[nodiscard]] Halo halo() const { return {kHalo / kBlockSide, halo_ / kBlockSide}; }

  /// The credible chunk at `key`; its masks are empty where nothing is known.
  [[nodiscard]] StatusChunk computeChunk(const FrozenMap::Blocks& blocks, PackedKey key) {
    load(blocks, key);
    StatusChunk chunk;
    chunk.key = key;
    if (free_.isEmpty() && occupied_.isEmpty() && !has_silence_) return chunk;
    closeSilence();
    closeColumns();
    growOccupied();
    endAtSilence();
    store(chunk);
    return chunk;
  }

 private:
  void load(const FrozenMap::Blocks& blocks, PackedKey key) {
    free_.clear();
    occupied_.clear();
    silent_.clear();
    has_silence_ = false;
    const VoxelIndex first = unpackIndex(key) - VoxelIndex(kHalo, kHalo, halo_);
    for (int z = 0; z < free_.layers(); z += kBlockSide)
      for (int y = 0; y < kRows; y += kBlockSide)
        for (int x = 0; x < kRows; x += kBlockSide) {
          const VoxelIndex corner = first + VoxelIndex(x, y, z);
          if (!isInKeyRange(corner)) continue;
          if (const StatusBlock* block = blocks.find(packIndex(corner))) loadBlock(*block, x, y, z);
        }
  }

  void loadBlock(const StatusBlock& block, int x, int y, int z) {
    for (int k = 0; k < kBlockSide; ++k) {
      const std::uint64_t occupied = block.occupied[static_cast<std::size_t>(k)];
      const std::uint64_t free = block.known[static_cast<std::size_t>(k)] & ~occupied;
      const std::uint64_t silent = block.silent[static_cast<std::size_t>(k)];
      if ((free | occupied | silent) == 0) continue;
      has_silence_ |= silent != 0;
      for (int j = 0; j < kBlockSide; ++j) {
        free_.at(y + j, z + k) |= ((free >> (8 * j)) & 0xFF) << x;
        occupied_.at(y + j, z + k) |= ((occupied >> (8 * j)) & 0xFF) << x;
        silent_.at(y + j, z + k) |= ((silent >> (8 * j)) & 0xFF) << x;
      }
    }
  }

  /// Between the rows that look into an opening in vain there are gaps as well.
  SPELUNK_WIDE_IF_POSSIBLE void closeSilence() {
    if (!has_silence_ || gap_ <= 0) return;
    gaps_ = silent_;
    spreadUp(gaps_, gap_ + 1);
    shrinkDown(gaps_, gap_ + 1);
    for (int z = 0; z < gaps_.layers(); ++z)
      for (int y = 0; y < kRows; ++y)
        silent_.at(y, z) |= gaps_.at(y, z) & ~(free_.at(y, z) | occupied_.at(y, z));
  }

  /// Step 1: a closing by gap + 1 in z finds the gaps; free space spreads up and down through them;
  /// what it does not reach is solid. Silent voxels bound gaps and are none.
  SPELUNK_WIDE_IF_POSSIBLE void closeColumns() {
    if (gap_ <= 0) return;
    for (int z = 0; z < gaps_.layers(); ++z)
      for (int y = 0; y < kRows; ++y)
        gaps_.at(y, z) = free_.at(y, z) | occupied_.at(y, z) | silent_.at(y, z);
    spreadUp(gaps_, gap_ + 1);
    shrinkDown(gaps_, gap_ + 1);
    for (int z = 0; z < gaps_.layers(); ++z)
      for (int y = 0; y < kRows; ++y)
        gaps_.at(y, z) &= ~(free_.at(y, z) | occupied_.at(y, z) | silent_.at(y, z));
    const auto spread = [&](int from, int to) {
      for (int y = 0; y < kRows; ++y) free_.at(y, to) |= free_.at(y, from) & gaps_.at(y, to);
    };
    for (int z = 1; z < free_.layers(); ++z) spread(z - 1, z);
    for (int z = free_.layers() - 1; z > 0; --z) spread(z, z - 1);
    for (int z = 0; z < gaps_.layers(); ++z)
      for (int y = 0; y < kRows; ++y) occupied_.at(y, z) |= gaps_.at(y, z) & ~free_.at(y, z);
  }

  /// Fills wide_ with what lies near bits of `rows`, where the chunk itself is affected.
  SPELUNK_WIDE_IF_POSSIBLE void widen(const Rows& rows) {
    for (int z = halo_ - 1; z <= halo_ + kChunkSide; ++z) {
      std::uint64_t row[kRows];
      for (int y = 0; y < kRows; ++y) {
        const std::uint64_t in = rows.at(y, z);
        row[y] = in;
        for (int k = 1; k <= reach_; ++k) row[y] |= in << k | in >> k;
      }
      for (int y = kHalo; y < kHalo + kChunkSide; ++y) {
        std::uint64_t all = 0;
        for (int k = -reach_; k <= reach_; ++k) all |= row[y + k];
        wide_.at(y, z) = all;
      }
    }
  }
  [[nodiscard]] std::uint64_t widened(int y, int z) const {
    return wide_.at(y, z - 1) | wide_.at(y, z) | wide_.at(y, z + 1);
  }

  /// Step 2, where the chunk itself is affected.
  SPELUNK_WIDE_IF_POSSIBLE void growOccupied() {
    if (reach_ <= 0) return;
    widen(occupied_);
    for (int z = halo_; z < halo_ + kChunkSide; ++z)
      for (int y = kHalo; y < kHalo + kChunkSide; ++y) {
        occupied_.at(y, z) |= widened(y, z);
        free_.at(y, z) &= ~occupied_.at(y, z);
      }
  }

  /// Step 3: silent voxels and unknown ones as near to them as rock grows are solid.
  SPELUNK_WIDE_IF_POSSIBLE void endAtSilence() {
    if (!has_silence_) return;
    widen(silent_);
    for (int z = halo_; z < halo_ + kChunkSide; ++z)
      for (int y = kHalo; y < kHalo + kChunkSide; ++y)
        occupied_.at(y, z) |= widened(y, z) & ~free_.at(y, z);
  }

  void store(StatusChunk& chunk) const {
    for (int z = 0; z < kChunkSide; ++z)
      for (int y = 0; y < kChunkSide; ++y) {
        const std::uint64_t occupied = occupied_.at(kHalo + y, halo_ + z) >> kHalo;
        const std::uint64_t known = occupied | free_.at(kHalo + y, halo_ + z) >> kHalo;
        for (int x = 0; x < kChunkSide; x += kBlockSide) {
          const std::size_t slot = StatusChunk::slotOf(packKey(x, y, z));
          StatusBlock& block = chunk.blocks[slot];
          const auto word = static_cast<std::size_t>(z % kBlockSide);
          const int shift = 8 * (y % kBlockSide);
          block.known[word] |= ((known >> x) & 0xFF) << shift;
          block.occupied[word] |= ((occupied >> x) & 0xFF) << shift;
        }
      }
  }

  int gap_;
  int reach_;
  int halo_;  ///< Voxels above and below a chunk that are looked at.
  Rows free_;
  Rows occupied_;
  Rows gaps_;
  Rows wide_;
  Rows silent_;
  bool has_silence_ = false;
};

struct VoxelCounts {
  std::size_t free = 0;
  std::size_t occupied = 0;
};

VoxelCounts countsOf(const StatusChunk& chunk) {
  VoxelCounts counts;
  for (const StatusBlock& block : chunk.blocks)
    for (std::size_t z = 0; z < kBlockSide; ++z) {
      const auto occupied = static_cast<std::size_t>(__builtin_popcountll(block.occupied[z]));
      counts.occupied += occupied;
      counts.free += static_cast<std::size_t>(__builtin_popcountll(block.known[z])) - occupied;
    }
  return counts;
}

/// Which chunks beside one its block at `place` (0 to 3) is part of the surroundings of: from..to.
struct Sides {
  int from;
  int to;
};
Sides sidesOf(int place, int halo) {
  constexpr int kBlocks = kChunkSide / kBlockSide;
  return {place < halo ? -1 : 0, place >= kBlocks - halo ? 1 : 0};
}

bool differ(const StatusBlock& a, const StatusBlock& b) {
  return a.known != b.known || a.occupied != b.occupied || a.silent != b.silent;
}

/// Marks the chunks around `now`, as a bit each of 27, that its changes since `before` matter to.
std::uint32_t affectedAround(const StatusChunk& now, const StatusChunk& before, const Halo& halo) {
  std::uint32_t affected = 0;
  for (int slot = 0; slot < 64; ++slot) {
    const auto number = static_cast<std::size_t>(slot);
    if (!differ(now.blocks[number], before.blocks[number])) continue;
    const Sides x = sidesOf(slot & 3, halo.sideways);
    const Sides y = sidesOf((slot >> 2) & 3, halo.sideways);
    const Sides z = sidesOf(slot >> 4, halo.upwards);
    for (int k = z.from; k <= z.to; ++k)
      for (int j = y.from; j <= y.to; ++j)
        for (int i = x.from; i <= x.to; ++i) affected |= 1U << (13 + i + 3 * j + 9 * k);
  }
  return affected;
}

/// The chunks whose surroundings changed between two snapshots, in a fixed order.
std::vector<PackedKey> touchedChunks(const FrozenMap::Blocks& now, const FrozenMap::Blocks& before,
                                     const Halo& halo) {
  const StatusChunk nothing;
  std::vector<PackedKey> touched;
  for (std::size_t i = 0; i < now.chunks.size(); ++i) {
    const bool is_new = i >= before.chunks.size();
    if (!is_new && before.chunks[i] == now.chunks[i]) continue;
    const std::uint32_t affected =
        affectedAround(*now.chunks[i], is_new ? nothing : *before.chunks[i], halo);
    const VoxelIndex corner = unpackIndex(now.chunks[i]->key);
    for (int k = 0; k < 27; ++k) {
      if (((affected >> k) & 1) == 0) continue;
      const VoxelIndex near =
          corner + kChunkSide * (VoxelIndex(k % 3, k / 3 % 3, k / 9) - VoxelIndex::Ones());
      if (isInKeyRange(near)) touched.push_back(packIndex(near));
    }
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

}  // namespace

struct CredibleMap::Impl {
  Credibility credibility;
  std::shared_ptr<const FrozenMap> source;
  std::shared_ptr<const FrozenMap> result;

  [[nodiscard]] ChunkFilter filterFor(double resolution_m) const {
    const auto voxels = [&](double metres) {
      return static_cast<int>(std::lround(metres / resolution_m));
    };
    return {std::min(voxels(credibility.closing_height_m), kGapMax),
            std::min(voxels(credibility.growth_m), kGrowthMax)};
  }

  [[nodiscard]] bool continues(const FrozenMap& map) const {
    return source != nullptr && source->resolution() == map.resolution() &&
           isLaterThan(map.blocks(), source->blocks());
  }

  void update(const FrozenMap& map) {
    const FrozenMap::Blocks nothing;
    const bool goes_on = continues(map);
    auto next = std::make_shared<FrozenMap::Blocks>(goes_on ? result->blocks() : nothing);
    auto table = std::make_shared<KeyTable>(*next->table);
    ChunkFilter filter = filterFor(map.resolution());
    for (const PackedKey key :
         touchedChunks(map.blocks(), goes_on ? source->blocks() : nothing, filter.halo())) {
      auto chunk = std::make_shared<StatusChunk>(filter.computeChunk(map.blocks(), key));
      const VoxelCounts counts = countsOf(*chunk);
      const std::uint32_t number = table->find(key);
      const bool is_new = number == KeyTable::kAbsent;
      if (is_new && counts.free + counts.occupied == 0) continue;
      const VoxelCounts before = is_new ? VoxelCounts{} : countsOf(*next->chunks[number]);
      next->free_voxels += counts.free - before.free;
      next->occupied_voxels += counts.occupied - before.occupied;
      if (is_new) {
        table->insert(key, static_cast<std::uint32_t>(next->chunks.size()));
        next->chunks.push_back(std::move(chunk));
      } else {
        next->chunks[number] = std::move(chunk);
      }
    }
    next->table = std::move(table);
    next->known = map.blocks().known;
    next->known.min.array() -= kGrowthMax;
    next->known.max.array() += kGrowthMax;
    result = std::make_shared<const FrozenMap>(std::move(next), map.resolution());
  }
};

CredibleMap::CredibleMap(const Credibility& credibility) : impl_(std::make_unique<Impl>()) {
  impl_->credibility = credibility;
}
CredibleMap::~CredibleMap() = default;
CredibleMap::CredibleMap(CredibleMap&&) noexcept = default;
CredibleMap& CredibleMap::operator=(CredibleMap&&) noexcept = default;

std::shared_ptr<const FrozenMap> CredibleMap::of(std::shared_ptr<const FrozenMap> map) {
  require(map != nullptr, "CredibleMap: no map");
  if (impl_->source != map) {
    impl_->update(*map);
    impl_->source = std::move(map);
  }
  return impl_->result;
}

}  // namespace spelunk::map
