#include <algorithm>
#include <cmath>

#include "spelunk/terrain/traversability.h"
#include "window_filters.h"

namespace spelunk::terrain {
namespace {

constexpr float kLeastCells = 6.0F;
constexpr float kLeastSpread = 0.3F;  // of the cells across, as a share of a full window's

enum RowSum { kN, kX, kXX, kZ, kXZ, kZZ };

/// Sums over a window, x and y in cells from its middle.
struct WindowSums {
  float n = 0.0F, x = 0.0F, y = 0.0F, xx = 0.0F, xy = 0.0F, yy = 0.0F;
  float z = 0.0F, xz = 0.0F, yz = 0.0F, zz = 0.0F;
};

struct Plane {
  float slope;  ///< Tangent with heights and cells in one unit; negative if there is no plane.
  float roughness;
};

/// Least squares; the cells must not lie on a line.
Plane planeOf(const WindowSums& s, float least_variance) {
  const float n = std::max(s.n, 1.0F);
  const float xx = s.xx - s.x * s.x / n;
  const float xy = s.xy - s.x * s.y / n;
  const float yy = s.yy - s.y * s.y / n;
  const float xz = s.xz - s.x * s.z / n;
  const float yz = s.yz - s.y * s.z / n;
  const float zz = s.zz - s.z * s.z / n;
  const float determinant = xx * yy - xy * xy;
  const float trace = xx + yy;
  const float root = std::sqrt(std::max(trace * trace - 4.0F * determinant, 0.0F));
  const bool is_plane = s.n >= kLeastCells && 0.5F * (trace - root) >= n * least_variance;
  const float divisor = is_plane ? determinant : 1.0F;
  const float a = (xz * yy - yz * xy) / divisor;
  const float b = (yz * xx - xz * xy) / divisor;
  const float residual = std::max(zz - a * xz - b * yz, 0.0F);
  return {is_plane ? std::sqrt(a * a + b * b) : -1.0F, std::sqrt(residual / n)};
}

}  // namespace

void Traversability::fitPlanes(const CellRect& rect) {
  sumRows(rect);
  for (int y = rect.y_begin; y < rect.y_end; ++y) solveRow(rect, y);
}

void Traversability::sumRows(const CellRect& rect) {
  const int count = rect.x_end - rect.x_begin;
  for (int y = rect.y_begin - plane_cells_; y < rect.y_end + plane_cells_; ++y) {
    const auto at = static_cast<std::size_t>(y * side_ + rect.x_begin);
    std::array<float*, 6> sums;
    for (std::size_t i = 0; i < 6; ++i) {
      sums[i] = row_sums_[i].data() + at;
      std::fill(sums[i], sums[i] + count, 0.0F);
    }
    for (int d = -plane_cells_; d <= plane_cells_; ++d) {
      const auto offset = static_cast<float>(d);
      const float* known = known_.data() + at + d;
      const float* height = height_.data() + at + d;
      for (int x = 0; x < count; ++x) {
        sums[kN][x] += known[x];
        sums[kX][x] += offset * known[x];
        sums[kXX][x] += offset * offset * known[x];
        sums[kZ][x] += height[x];
        sums[kXZ][x] += offset * height[x];
        sums[kZZ][x] += height[x] * height[x];
      }
    }
  }
}

void Traversability::solveRow(const CellRect& rect, int y) {
  const float full = static_cast<float>(2 * plane_cells_ + 1);
  const float least_variance = kLeastSpread * kLeastSpread * full * full / 12.0F;
  const auto at = static_cast<std::size_t>(y * side_ + rect.x_begin);
  for (std::size_t x = 0; x < static_cast<std::size_t>(rect.x_end - rect.x_begin); ++x) {
    WindowSums s;
    for (int d = -plane_cells_; d <= plane_cells_; ++d) {
      const std::size_t cell = at + x + static_cast<std::size_t>(d * side_);
      const auto offset = static_cast<float>(d);
      s.n += row_sums_[kN][cell];
      s.x += row_sums_[kX][cell];
      s.xx += row_sums_[kXX][cell];
      s.y += offset * row_sums_[kN][cell];
      s.yy += offset * offset * row_sums_[kN][cell];
      s.xy += offset * row_sums_[kX][cell];
      s.z += row_sums_[kZ][cell];
      s.xz += row_sums_[kXZ][cell];
      s.yz += offset * row_sums_[kZ][cell];
      s.zz += row_sums_[kZZ][cell];
    }
    const Plane plane = planeOf(s, least_variance);
    slope_[at + x] = plane.slope < 0.0F ? -1.0F : plane.slope / cell_m_;
    roughness_[at + x] = plane.roughness;
  }
}

}  // namespace spelunk::terrain
