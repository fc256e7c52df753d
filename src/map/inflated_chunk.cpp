#include "inflated_chunk.h"

#include <algorithm>

namespace spelunk::map {
namespace {

/// Rows of bits along x, row by row in y and layer by layer in z.
template <class Row>
struct Rows {
  int count_y;
  int count_z;
  std::vector<Row> bits;

  Rows(int rows, int layers)
      : count_y(rows), count_z(layers), bits(static_cast<std::size_t>(rows * layers), 0) {}

  Row* layer(int z) { return bits.data() + static_cast<std::ptrdiff_t>(z) * count_y; }
  const Row* layer(int z) const { return bits.data() + static_cast<std::ptrdiff_t>(z) * count_y; }
};

using LongRows = Rows<std::uint64_t>;
using ShortRows = Rows<std::uint32_t>;

/// Calls `combine` with shifts whose union makes runs of `length` from runs of one.
template <class Combine>
void forDoublings(int length, Combine&& combine) {
  for (int done = 1; done < length;) {
    const int shift = std::min(done, length - done);
    combine(shift);
    done += shift;
  }
}

std::uint64_t runsAlongX(std::uint64_t row, int length) {
  forDoublings(length, [&](int shift) { row &= row >> shift; });
  return row;
}

/// Each row becomes the AND of itself and the row `shift` after it; what lies beyond the last is
/// not looked at by any row that is kept.
void andAfterInY(ShortRows& rows, int shift) {
  for (int z = 0; z < rows.count_z; ++z) {
    std::uint32_t* layer = rows.layer(z);
    for (int y = 0; y + shift < rows.count_y; ++y) layer[y] &= layer[y + shift];
  }
}

void andAfterInZ(ShortRows& rows, int shift) {
  for (int z = 0; z + shift < rows.count_z; ++z) {
    std::uint32_t* to = rows.layer(z);
    const std::uint32_t* from = rows.layer(z + shift);
    for (int y = 0; y < rows.count_y; ++y) to[y] &= from[y];
  }
}

ShortRows firstRows(const ShortRows& rows, int count) {
  ShortRows kept(count, rows.count_z);
  for (int z = 0; z < rows.count_z; ++z) std::copy_n(rows.layer(z), count, kept.layer(z));
  return kept;
}

/// The passable voxels of the chunks, as far as boxes that begin in the first one reach.
class PassableRows {
 public:
  PassableRows(const VoxelIndex& reach, Passable passable)
      : rows_(kChunkSide + reach.y(), kChunkSide + reach.z()), passable_(passable) {
    if (passable == Passable::kNotOccupied) std::fill(rows_.bits.begin(), rows_.bits.end(), ~0ULL);
  }

  void load(const InflatedChunk::Sources& sources) {
    for (std::size_t k = 0; k < sources.size(); ++k) {
      const VoxelIndex place(static_cast<int>(k & 1), static_cast<int>(k >> 1 & 1),
                             static_cast<int>(k >> 2));
      if (sources[k] != nullptr) loadChunk(*sources[k], kChunkSide * place);
    }
  }
  [[nodiscard]] const LongRows& rows() const { return rows_; }

 private:
  void loadChunk(const StatusChunk& chunk, const VoxelIndex& at) {
    for (int slot = 0; slot < 64; ++slot) {
      const VoxelIndex first = at + kBlockSide * VoxelIndex(slot & 3, slot >> 2 & 3, slot >> 4);
      if (first.y() >= rows_.count_y || first.z() >= rows_.count_z) continue;
      loadBlock(chunk.blocks[static_cast<std::size_t>(slot)], first);
    }
  }

  void loadBlock(const StatusBlock& block, const VoxelIndex& first) {
    const int layers = std::min(kBlockSide, rows_.count_z - first.z());
    const int count = std::min(kBlockSide, rows_.count_y - first.y());
    for (int z = 0; z < layers; ++z) {
      const auto word = static_cast<std::size_t>(z);
      std::uint64_t* rows = rows_.layer(first.z() + z) + first.y();
      const std::uint64_t occupied = block.occupied[word];
      const std::uint64_t free = block.known[word] & ~occupied;
      if (passable_ == Passable::kNotOccupied)
        for (int y = 0; y < count; ++y) rows[y] &= ~(((occupied >> (8 * y)) & 0xFF) << first.x());
      else
        for (int y = 0; y < count; ++y) rows[y] |= ((free >> (8 * y)) & 0xFF) << first.x();
    }
  }

  LongRows rows_;
  Passable passable_;
};

/// The bits of the first chunk of runs along x, and of runs longer by one.
std::array<ShortRows, 2> erodedInX(const LongRows& free, int least) {
  std::array<ShortRows, 2> eroded{ShortRows(free.count_y, free.count_z),
                                  ShortRows(free.count_y, free.count_z)};
  for (std::size_t i = 0; i < free.bits.size(); ++i) {
    const std::uint64_t runs = runsAlongX(free.bits[i], least + 1);
    eroded[0].bits[i] = static_cast<std::uint32_t>(runs);
    eroded[1].bits[i] = static_cast<std::uint32_t>(runs & (runs >> 1));
  }
  return eroded;
}

std::array<ShortRows, 2> erodedInY(ShortRows rows, int least) {
  forDoublings(least + 1, [&](int shift) { andAfterInY(rows, shift); });
  ShortRows longer = rows;
  andAfterInY(longer, 1);
  return {firstRows(rows, kChunkSide), firstRows(longer, kChunkSide)};
}

std::array<ShortRows, 2> erodedInZ(ShortRows rows, int least) {
  forDoublings(least + 1, [&](int shift) { andAfterInZ(rows, shift); });
  ShortRows longer = rows;
  andAfterInZ(longer, 1);
  return {std::move(rows), std::move(longer)};
}

}  // namespace

InflatedChunk::InflatedChunk(const Sources& sources, const BoxSpan& span, Passable passable) {
  const VoxelIndex reach = span.least + VoxelIndex::Ones();
  PassableRows free(reach, passable);
  free.load(sources);
  const auto hasBits = [](const ShortRows& rows) {
    return std::any_of(rows.bits.begin(), rows.bits.end(), [](auto row) { return row != 0; });
  };
  const auto in_x = erodedInX(free.rows(), span.least.x());
  if (!hasBits(in_x[0])) return;
  rows_.resize(8);
  for (std::size_t x = 0; x < 2; ++x) {
    const auto in_y = erodedInY(in_x[x], span.least.y());
    for (std::size_t y = 0; y < 2; ++y) {
      const auto in_z = erodedInZ(in_y[y], span.least.z());
      for (std::size_t z = 0; z < 2; ++z)
        std::copy_n(in_z[z].bits.begin(), rows_.front().size(), rows_[x + 2 * y + 4 * z].begin());
    }
  }
  const Rows& loosest = rows_.front();
  is_blocked_ = std::all_of(loosest.begin(), loosest.end(), [](auto row) { return row == 0; });
  if (is_blocked_) rows_.clear();
}

}  // namespace spelunk::map
