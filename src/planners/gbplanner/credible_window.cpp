#include "spelunk/planners/gbplanner/credible_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace spelunk::planners::gbplanner {
namespace {

constexpr std::uint8_t kUnknown = 0;
constexpr std::uint8_t kFree = 1;
constexpr std::uint8_t kOccupied = 2;
constexpr std::uint8_t kOpen = 3;  // unknown, and worth looking into

/// The cells of a window while they are rewritten; x is the fastest axis.
struct Cells {
  std::vector<std::uint8_t> values;
  int nx = 0;
  int ny = 0;
  int nz = 0;
  std::ptrdiff_t row = 0;    // one step in y
  std::ptrdiff_t layer = 0;  // one step in z

  [[nodiscard]] std::uint8_t* rowAt(int y, int z) { return values.data() + z * layer + y * row; }

  /// Calls visit(x, cell) for every known cell of a row; empty stretches are skipped eight at once.
  template <class Visit>
  void forEachKnown(int y, int z, Visit&& visit) {
    std::uint8_t* cells = rowAt(y, z);
    for (int x = 0; x < nx;) {
      std::uint64_t eight = 0;
      if (x + 8 <= nx) {
        std::memcpy(&eight, cells + x, sizeof eight);
        if (eight == 0) {
          x += 8;
          continue;
        }
      }
      for (const int end = std::min(x + 8, nx); x < end; ++x) {
        if (cells[x] != kUnknown) visit(x, cells + x);
      }
    }
  }
};

void closeColumns(Cells& cells, int gap_max) {
  std::vector<int> last(static_cast<std::size_t>(cells.nx));
  for (int y = 0; y < cells.ny; ++y) {
    std::fill(last.begin(), last.end(), -1);
    for (int z = 0; z < cells.nz; ++z) {
      cells.forEachKnown(y, z, [&](int x, std::uint8_t* cell) {
        int& below = last[static_cast<std::size_t>(x)];
        const int gap = z - below - 1;
        if (below >= 0 && gap > 0 && gap <= gap_max) {
          const bool solid = *cell == kOccupied && *(cell - (gap + 1) * cells.layer) == kOccupied;
          for (int k = 1; k <= gap; ++k) *(cell - k * cells.layer) = solid ? kOccupied : kFree;
        }
        below = z;
      });
    }
  }
}

/// Marks the unknown neighbours of free cells to one side where the free space ends so over at
/// least `height` cells on end.
void openSide(Cells& cells, int dx, int dy, int height) {
  const std::ptrdiff_t side = dx + dy * cells.row;
  std::vector<int> run(static_cast<std::size_t>(cells.nx));
  std::vector<int> seen_at(static_cast<std::size_t>(cells.nx));
  for (int y = std::max(0, -dy); y < cells.ny - std::max(0, dy); ++y) {
    std::fill(seen_at.begin(), seen_at.end(), -2);
    for (int z = 0; z < cells.nz; ++z) {
      cells.forEachKnown(y, z, [&](int x, std::uint8_t* cell) {
        if (x + dx < 0 || x + dx >= cells.nx || *cell != kFree) return;
        const std::uint8_t beside = *(cell + side);
        if (beside != kUnknown && beside != kOpen) return;
        const auto i = static_cast<std::size_t>(x);
        run[i] = seen_at[i] == z - 1 ? run[i] + 1 : 1;
        seen_at[i] = z;
        if (run[i] < height) return;
        std::uint8_t* open = cell + side;
        for (int k = 0; k < height; ++k) *(open - k * cells.layer) = kOpen;
      });
    }
  }
}

void sealTheRest(Cells& cells) {
  for (int z = 0; z < cells.nz; ++z) {
    for (int y = 0; y < cells.ny; ++y) {
      cells.forEachKnown(y, z, [&](int x, std::uint8_t* cell) {
        if (*cell != kFree) return;
        const auto seal = [](std::uint8_t* neighbour) {
          if (*neighbour == kUnknown) *neighbour = kOccupied;
        };
        if (x > 0) seal(cell - 1);
        if (x + 1 < cells.nx) seal(cell + 1);
        if (y > 0) seal(cell - cells.row);
        if (y + 1 < cells.ny) seal(cell + cells.row);
        if (z > 0) seal(cell - cells.layer);
        if (z + 1 < cells.nz) seal(cell + cells.layer);
      });
    }
  }
  for (std::uint8_t& value : cells.values) value = value == kOpen ? kUnknown : value;
}

}  // namespace

map::LocalWindow credibleWindow(const map::LocalWindow& window, const Credibility& credibility) {
  Cells cells;
  cells.values = window.cells();
  cells.nx = window.size().x();
  cells.ny = window.size().y();
  cells.nz = window.size().z();
  cells.row = cells.nx;
  cells.layer = cells.row * cells.ny;
  const auto voxels = [&](double metres) {
    return static_cast<int>(std::lround(metres / window.resolution()));
  };
  closeColumns(cells, voxels(credibility.closing_height_m));
  const int height = std::max(1, voxels(credibility.opening_height_m));
  for (const auto& [dx, dy] : std::array<std::pair<int, int>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}})
    openSide(cells, dx, dy, height);
  sealTheRest(cells);
  return window.withCells(std::move(cells.values));
}

}  // namespace spelunk::planners::gbplanner
