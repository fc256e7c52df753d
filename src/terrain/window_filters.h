#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace spelunk::terrain {

/// Stands for nothing known in minima; negative in maxima. Finite, so that sums stay numbers.
constexpr float kVeryHigh = 1e6F;

constexpr int kTile = 16;  ///< Side of the squares of cells that are recomputed together.

/// Of cells whose traversability is unknown.
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// Cells worked on at a time; layers are readable and writable so many cells beyond their end.
constexpr int kLanes = 4;

/// Cells [begin, end) of a square layer.
struct CellRect {
  int x_begin = 0;
  int y_begin = 0;
  int x_end = 0;
  int y_end = 0;
  [[nodiscard]] CellRect grown(int cells) const {
    return {x_begin - cells, y_begin - cells, x_end + cells, y_end + cells};
  }
};

/// Filters over the square window of `reach` cells each way, for the cells of `rect`; layers are
/// side x side, x fastest, and must hold the window of every cell of `rect`. `rows` is working
/// memory.
void slidingMin(const std::vector<float>& in, int side, const CellRect& rect, int reach,
                std::vector<float>& rows, std::vector<float>& out);
void slidingMax(const std::vector<float>& in, int side, const CellRect& rect, int reach,
                std::vector<float>& rows, std::vector<float>& out);
/// The maximum of in - curvature * (dx^2 + dy^2).
void slidingParabola(const std::vector<float>& in, int side, const CellRect& rect, int reach,
                     float curvature, std::vector<float>& rows, std::vector<float>& out);

/// Whether an unknown cell of `rect` has a bound more than `margin` below the highest entry of
/// `ground` in the rect grown by `reach`.
[[nodiscard]] bool anyBelow(const std::vector<float>& bound, const std::vector<float>& known,
                            const std::vector<float>& ground, int side, const CellRect& rect,
                            int reach, float margin);

}  // namespace spelunk::terrain
