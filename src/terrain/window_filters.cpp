#include "window_filters.h"

#include <algorithm>

namespace spelunk::terrain {
namespace {

/// out[x] = best over d of combine(in[x + d * stride], d), for one row of cells.
template <class Combine>
void filterRow(const float* in, int count, int reach, std::ptrdiff_t stride, float* out,
               Combine combine) {
  for (int x = 0; x < count; ++x) out[x] = combine(in[x - reach * stride], -reach, in[x]);
  for (int d = 1 - reach; d <= reach; ++d) {
    const float* shifted = in + d * stride;
    for (int x = 0; x < count; ++x) out[x] = combine(shifted[x], d, out[x]);
  }
}

/// Along x for all rows that are needed, then along y.
template <class Combine>
void filter(const std::vector<float>& in, int side, const CellRect& rect, int reach,
            std::vector<float>& rows, std::vector<float>& out, Combine combine) {
  const int count = rect.x_end - rect.x_begin;
  for (int y = rect.y_begin - reach; y < rect.y_end + reach; ++y) {
    const auto at = static_cast<std::size_t>(y * side + rect.x_begin);
    filterRow(in.data() + at, count, reach, 1, rows.data() + at, combine);
  }
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const auto at = static_cast<std::size_t>(y * side + rect.x_begin);
    filterRow(rows.data() + at, count, reach, side, out.data() + at, combine);
  }
}

}  // namespace

void slidingMin(const std::vector<float>& in, int side, const CellRect& rect, int reach,
                std::vector<float>& rows, std::vector<float>& out) {
  filter(in, side, rect, reach, rows, out,
         [](float value, int /*d*/, float best) { return std::min(value, best); });
}

void slidingMax(const std::vector<float>& in, int side, const CellRect& rect, int reach,
                std::vector<float>& rows, std::vector<float>& out) {
  filter(in, side, rect, reach, rows, out,
         [](float value, int /*d*/, float best) { return std::max(value, best); });
}

void slidingParabola(const std::vector<float>& in, int side, const CellRect& rect, int reach,
                     float curvature, std::vector<float>& rows, std::vector<float>& out) {
  filter(in, side, rect, reach, rows, out, [curvature](float value, int d, float best) {
    return std::max(value - curvature * static_cast<float>(d * d), best);
  });
}

bool anyBelow(const std::vector<float>& bound, const std::vector<float>& known,
              const std::vector<float>& ground, int side, const CellRect& rect, int reach,
              float margin) {
  float least = kVeryHigh;
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const auto cell = static_cast<std::size_t>(y * side + x);
      least = std::min(least, known[cell] == 0.0F ? bound[cell] : kVeryHigh);
    }
  if (least >= kVeryHigh) return false;
  const CellRect around = rect.grown(reach);
  float top = -kVeryHigh;
  for (int y = around.y_begin; y < around.y_end; ++y)
    for (int x = around.x_begin; x < around.x_end; ++x)
      top = std::max(top, ground[static_cast<std::size_t>(y * side + x)]);
  return least < top - margin;
}

}  // namespace spelunk::terrain
