#include "inflated_chunk.h"

#include <algorithm>

namespace spelunk::map {
namespace {

/// Rows of bits along x, row by row in y and layer by layer in z.
struct Rows {
  int count_y;
  int count_z;
  std::vector<std::uint64_t> bits;

  Rows(int rows, int layers)
      : count_y(rows), count_z(layers), bits(static_cast<std::size_t>(rows * layers), 0) {}

  std::uint64_t* layer(int z) { return bits.data() + static_cast<std::ptrdiff_t>(z) * count_y; }
};

/// Calls `combine` with shifts whose union makes runs of `length` from runs of one.
template <class Combine>
void forDoublings(int length, Combine&& combine) {
  for (int done = 1; done < length;) {
    const int shift = std::min(done, length - done);
    combine(shift);
    done += shift;
  }
}

/// The functions below leave the bits that begin a run of `length` along their axis. What lies
/// beyond the last row is not looked at by any row that is kept.
void keepRunsInX(Rows& rows, int length) {
  forDoublings(length, [&](int shift) {
    for (std::uint64_t& row : rows.bits) row &= row >> shift;
  });
}

void keepRunsInY(Rows& rows, int length) {
  forDoublings(length, [&](int shift) {
    for (int z = 0; z < rows.count_z; ++z) {
      std::uint64_t* layer = rows.layer(z);
      for (int y = 0; y + shift < rows.count_y; ++y) layer[y] &= layer[y + shift];
    }
  });
}

void keepRunsInZ(Rows& rows, int length) {
  forDoublings(length, [&](int shift) {
    for (int z = 0; z + shift < rows.count_z; ++z) {
      std::uint64_t* to = rows.layer(z);
      const std::uint64_t* from = rows.layer(z + shift);
      for (int y = 0; y < rows.count_y; ++y) to[y] &= from[y];
    }
  });
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
  [[nodiscard]] Rows& rows() { return rows_; }

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

  Rows rows_;
  Passable passable_;
};

}  // namespace

InflatedChunk::InflatedChunk(const Sources& sources, const BoxSpan& span, Passable passable) {
  PassableRows free(span.least + VoxelIndex::Ones(), passable);
  free.load(sources);
  Rows& boxes = free.rows();
  keepRunsInX(boxes, span.least.x() + 1);
  keepRunsInY(boxes, span.least.y() + 1);
  keepRunsInZ(boxes, span.least.z() + 1);
  constexpr std::uint64_t kKept = (std::uint64_t{1} << kRows) - 1;
  rows_.reserve(static_cast<std::size_t>(kRows * kRows));
  for (int z = 0; z < kRows; ++z)
    for (int y = 0; y < kRows; ++y) rows_.push_back(boxes.layer(z)[y] & kKept);
  const bool is_blocked =
      std::all_of(rows_.begin(), rows_.end(), [](std::uint64_t row) { return row == 0; });
  if (is_blocked) rows_.clear();
}

}  // namespace spelunk::map
