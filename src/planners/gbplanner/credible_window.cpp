#include "spelunk/planners/gbplanner/credible_window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace spelunk::planners::gbplanner {
namespace {

using Word = std::uint64_t;
constexpr int kBits = 64;

/// One bit a voxel; a word holds 64 voxels on end in x. A layer is all words of one height, so that
/// steps in z act on whole layers and steps in y on whole rows.
class BitPlanes {
 public:
  BitPlanes(int words_in_row, int rows, int layers)
      : words_in_row_(words_in_row),
        rows_(rows),
        layers_(layers),
        words_(static_cast<std::size_t>(words_in_row) * static_cast<std::size_t>(rows) *
               static_cast<std::size_t>(layers)) {}

  [[nodiscard]] int layers() const { return layers_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int wordsInRow() const { return words_in_row_; }
  [[nodiscard]] std::size_t layerSize() const {
    return static_cast<std::size_t>(words_in_row_) * static_cast<std::size_t>(rows_);
  }
  [[nodiscard]] Word* layer(int z) {
    return words_.data() + static_cast<std::size_t>(z) * layerSize();
  }
  [[nodiscard]] const Word* layer(int z) const {
    return words_.data() + static_cast<std::size_t>(z) * layerSize();
  }
  [[nodiscard]] std::vector<Word>& words() { return words_; }
  [[nodiscard]] const std::vector<Word>& words() const { return words_; }

 private:
  int words_in_row_;
  int rows_;
  int layers_;
  std::vector<Word> words_;
};

/// Bit i of the result is bit 0 of byte i.
Word gather(Word bytes) { return ((bytes & 0x0101010101010101ULL) * 0x0102040810204080ULL) >> 56; }
/// Byte i of the result is bit i.
Word scatter(Word bits) {
  const Word spread = (bits * 0x0101010101010101ULL) & 0x8040201008040201ULL;
  return ((spread + 0x7F7F7F7F7F7F7F7FULL) >> 7) & 0x0101010101010101ULL;
}

struct Planes {
  BitPlanes free;
  BitPlanes occupied;
};

Planes planesOf(const map::LocalWindow& window) {
  const int nx = window.size().x();
  const int words = (nx + kBits - 1) / kBits;
  Planes planes{{words, window.size().y(), window.size().z()},
                {words, window.size().y(), window.size().z()}};
  const std::uint8_t* cells = window.cells().data();
  const std::size_t rows = window.cells().size() / static_cast<std::size_t>(nx);
  for (std::size_t row = 0; row < rows; ++row, cells += nx) {
    Word* free = planes.free.words().data() + row * static_cast<std::size_t>(words);
    Word* occupied = planes.occupied.words().data() + row * static_cast<std::size_t>(words);
    for (int x = 0; x < nx; x += 8) {
      Word eight = 0;
      std::memcpy(&eight, cells + x, static_cast<std::size_t>(std::min(8, nx - x)));
      if (eight == 0) continue;
      free[x / kBits] |= gather(eight) << (x % kBits);
      occupied[x / kBits] |= gather(eight >> 1) << (x % kBits);
    }
  }
  return planes;
}

/// The voxels of `planes` in gaps of columns of at most `gap` voxels: a closing by gap + 1 in z.
BitPlanes closedColumns(const BitPlanes& known, int gap) {
  const std::size_t size = known.layerSize();
  BitPlanes near_below(known.wordsInRow(), known.rows(), known.layers() + gap);
  for (int z = 0; z < near_below.layers(); ++z) {
    Word* out = near_below.layer(z);
    for (int k = std::max(0, z - known.layers() + 1); k <= std::min(gap, z); ++k) {
      const Word* in = known.layer(z - k);
      for (std::size_t i = 0; i < size; ++i) out[i] |= in[i];
    }
  }
  BitPlanes closed(known.wordsInRow(), known.rows(), known.layers());
  for (int z = 0; z < closed.layers(); ++z) {
    Word* out = closed.layer(z);
    std::fill(out, out + size, ~Word{0});
    for (int k = 0; k <= gap; ++k) {
      const Word* in = near_below.layer(z + k);
      for (std::size_t i = 0; i < size; ++i) out[i] &= in[i];
    }
  }
  return closed;
}

/// Step 1 of credibleWindow().
void closeColumns(Planes& planes, int gap) {
  if (gap <= 0) return;
  BitPlanes filled(planes.free.wordsInRow(), planes.free.rows(), planes.free.layers());
  for (std::size_t i = 0; i < filled.words().size(); ++i)
    filled.words()[i] = planes.free.words()[i] | planes.occupied.words()[i];
  const BitPlanes closed = closedColumns(filled, gap);
  for (std::size_t i = 0; i < filled.words().size(); ++i)
    filled.words()[i] = closed.words()[i] & ~filled.words()[i];
  // Free space spreads up and down through the filled gaps; what it does not reach is solid.
  const std::size_t size = filled.layerSize();
  const auto spread = [&](int from, int to) {
    const Word* in = planes.free.layer(from);
    Word* out = planes.free.layer(to);
    const Word* gaps = filled.layer(to);
    for (std::size_t i = 0; i < size; ++i) out[i] |= in[i] & gaps[i];
  };
  for (int z = 1; z < filled.layers(); ++z) spread(z - 1, z);
  for (int z = filled.layers() - 1; z > 0; --z) spread(z, z - 1);
  for (std::size_t i = 0; i < filled.words().size(); ++i)
    planes.occupied.words()[i] |= filled.words()[i] & ~planes.free.words()[i];
}

enum class Side { kLeft, kRight, kFront, kBack };  // the neighbour at -x, +x, +y, -y

/// Adds to `out` every voxel that has a voxel of `in` (one layer) beside it: at that side of `in`.
void addShifted(const Word* in, Word* out, const BitPlanes& shape, Side side) {
  const std::ptrdiff_t row = shape.wordsInRow();
  for (int y = 0; y < shape.rows(); ++y) {
    for (std::ptrdiff_t w = 0; w < row; ++w) {
      const std::ptrdiff_t at = y * row + w;
      if (side == Side::kRight) out[at] |= (in[at] << 1) | (w > 0 ? in[at - 1] >> 63 : 0);
      if (side == Side::kLeft) out[at] |= (in[at] >> 1) | (w + 1 < row ? in[at + 1] << 63 : 0);
      if (side == Side::kFront && y > 0) out[at] |= in[at - row];
      if (side == Side::kBack && y + 1 < shape.rows()) out[at] |= in[at + row];
    }
  }
}

/// Step 2 of credibleWindow(): occupied voxels grow by `reach` voxels in x and y and one in z.
void growOccupied(Planes& planes, int reach) {
  if (reach <= 0) return;
  BitPlanes wide = planes.occupied;
  const std::size_t size = wide.layerSize();
  std::vector<Word> before(size);
  for (int z = 0; z < wide.layers(); ++z) {
    for (const auto& [one, other] :
         {std::pair{Side::kLeft, Side::kRight}, std::pair{Side::kFront, Side::kBack}}) {
      for (int k = 0; k < reach; ++k) {
        std::copy_n(wide.layer(z), size, before.begin());
        addShifted(before.data(), wide.layer(z), wide, one);
        addShifted(before.data(), wide.layer(z), wide, other);
      }
    }
  }
  for (int z = 0; z < wide.layers(); ++z) {
    Word* occupied = planes.occupied.layer(z);
    for (int near = std::max(0, z - 1); near <= std::min(z + 1, wide.layers() - 1); ++near) {
      const Word* in = wide.layer(near);
      for (std::size_t i = 0; i < size; ++i) occupied[i] |= in[i];
    }
    Word* free = planes.free.layer(z);
    for (std::size_t i = 0; i < size; ++i) free[i] &= ~occupied[i];
  }
}

std::vector<std::uint8_t> cellsOf(const Planes& planes, const map::LocalWindow& window) {
  std::vector<std::uint8_t> cells(window.cells().size());
  const int nx = window.size().x();
  const auto words = static_cast<std::size_t>(planes.free.wordsInRow());
  const std::size_t rows = cells.size() / static_cast<std::size_t>(nx);
  for (std::size_t row = 0; row < rows; ++row) {
    const Word* free = planes.free.words().data() + row * words;
    const Word* occupied = planes.occupied.words().data() + row * words;
    std::uint8_t* out = cells.data() + row * static_cast<std::size_t>(nx);
    for (int x = 0; x < nx; x += 8) {
      const Word f = (free[x / kBits] >> (x % kBits)) & 0xFF;
      const Word o = (occupied[x / kBits] >> (x % kBits)) & 0xFF;
      if ((f | o) == 0) continue;
      const Word eight = scatter(f) | (scatter(o) << 1);
      std::memcpy(out + x, &eight, static_cast<std::size_t>(std::min(8, nx - x)));
    }
  }
  return cells;
}

}  // namespace

map::LocalWindow credibleWindow(const map::LocalWindow& window, const Credibility& credibility) {
  const auto voxels = [&](double metres) {
    return static_cast<int>(std::lround(metres / window.resolution()));
  };
  Planes planes = planesOf(window);
  closeColumns(planes, voxels(credibility.closing_height_m));
  growOccupied(planes, voxels(credibility.growth_m));
  return window.withCells(cellsOf(planes, window));
}

}  // namespace spelunk::planners::gbplanner
