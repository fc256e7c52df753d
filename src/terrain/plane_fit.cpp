#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "spelunk/terrain/traversability.h"
#include "window_filters.h"

namespace spelunk::terrain {
namespace {

constexpr float kLeastCells = 6.0F;
constexpr float kLeastSpread = 0.3F;  // of the cells across, as a share of a full window's

enum RowSum { kN, kX, kXX, kZ, kXZ, kZZ };

/// Several cells at a time, one in a lane: the compiler does not find this by itself.
using Lanes = Eigen::Array<float, kLanes, 1>;

Lanes at(const std::vector<float>& layer, std::size_t cell) {
  return Eigen::Map<const Lanes>(layer.data() + cell);
}
void put(const Lanes& lanes, std::vector<float>& layer, std::size_t cell) {
  Eigen::Map<Lanes>(layer.data() + cell) = lanes;
}

struct Planes {
  Lanes slope;  ///< Tangent with heights and cells in one unit; negative if there is no plane.
  Lanes roughness;
};

/// Least squares; the cells must not lie on a line.
template <class WindowSums>
Planes planesOf(const WindowSums& s, float least_variance) {
  const Lanes n = s.n.max(1.0F);
  const Lanes xx = s.xx - s.x * s.x / n;
  const Lanes xy = s.xy - s.x * s.y / n;
  const Lanes yy = s.yy - s.y * s.y / n;
  const Lanes xz = s.xz - s.x * s.z / n;
  const Lanes yz = s.yz - s.y * s.z / n;
  const Lanes zz = s.zz - s.z * s.z / n;
  const Lanes determinant = xx * yy - xy * xy;
  const Lanes trace = xx + yy;
  const Lanes root = (trace * trace - 4.0F * determinant).max(0.0F).sqrt();
  const auto is_plane = (s.n >= kLeastCells && 0.5F * (trace - root) >= n * least_variance).eval();
  const Lanes divisor = is_plane.select(determinant, Lanes::Ones());
  const Lanes a = (xz * yy - yz * xy) / divisor;
  const Lanes b = (yz * xx - xz * xy) / divisor;
  const Lanes residual = (zz - a * xz - b * yz).max(0.0F);
  return {is_plane.select((a * a + b * b).sqrt(), -Lanes::Ones()), (residual / n).sqrt()};
}

}  // namespace

/// Sums over a window, x and y in cells from its middle.
struct Traversability::WindowSums {
  Lanes n = Lanes::Zero();
  Lanes x = Lanes::Zero();
  Lanes y = Lanes::Zero();
  Lanes xx = Lanes::Zero();
  Lanes xy = Lanes::Zero();
  Lanes yy = Lanes::Zero();
  Lanes z = Lanes::Zero();
  Lanes xz = Lanes::Zero();
  Lanes yz = Lanes::Zero();
  Lanes zz = Lanes::Zero();
};

void Traversability::fitPlanes(const CellRect& rect) {
  for (int y = rect.y_begin - plane_cells_; y < rect.y_end + plane_cells_; ++y)
    for (int x = rect.x_begin; x < rect.x_end; x += kLanes)
      sumRow(static_cast<std::size_t>(y * side_ + x));
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; x += kLanes)
      solve(static_cast<std::size_t>(y * side_ + x));
}

void Traversability::sumRow(std::size_t cell) {
  Lanes n = Lanes::Zero();
  Lanes x = Lanes::Zero();
  Lanes xx = Lanes::Zero();
  Lanes z = Lanes::Zero();
  Lanes xz = Lanes::Zero();
  Lanes zz = Lanes::Zero();
  for (int d = -plane_cells_; d <= plane_cells_; ++d) {
    const auto offset = static_cast<float>(d);
    const Lanes known = at(known_, cell + static_cast<std::size_t>(d));
    const Lanes height = at(height_, cell + static_cast<std::size_t>(d));
    n += known;
    x += offset * known;
    xx += offset * offset * known;
    z += height;
    xz += offset * height;
    zz += height * height;
  }
  put(n, row_sums_[kN], cell);
  put(x, row_sums_[kX], cell);
  put(xx, row_sums_[kXX], cell);
  put(z, row_sums_[kZ], cell);
  put(xz, row_sums_[kXZ], cell);
  put(zz, row_sums_[kZZ], cell);
}

void Traversability::addPlaces(std::size_t cell, WindowSums& s) const {
  for (int d = -plane_cells_; d <= plane_cells_; ++d) {
    const std::size_t row = cell + static_cast<std::size_t>(d * side_);
    const auto offset = static_cast<float>(d);
    const Lanes n = at(row_sums_[kN], row);
    const Lanes x = at(row_sums_[kX], row);
    s.y += offset * n;
    s.yy += offset * offset * n;
    s.x += x;
    s.xy += offset * x;
    s.xx += at(row_sums_[kXX], row);
  }
}

void Traversability::solve(std::size_t cell) {
  if ((at(known_, cell) == 0.0F).all()) return;
  const float full = static_cast<float>(2 * plane_cells_ + 1);
  WindowSums s;
  for (int d = -plane_cells_; d <= plane_cells_; ++d) {
    const std::size_t row = cell + static_cast<std::size_t>(d * side_);
    const Lanes z = at(row_sums_[kZ], row);
    s.n += at(row_sums_[kN], row);
    s.z += z;
    s.yz += static_cast<float>(d) * z;
    s.xz += at(row_sums_[kXZ], row);
    s.zz += at(row_sums_[kZZ], row);
  }
  if ((s.n == full * full).all()) {  // whole numbers: the sums below, exactly
    const auto k = static_cast<float>(plane_cells_);
    s.xx = s.yy = Lanes::Constant(full * full * k * (k + 1.0F) / 3.0F);
  } else {
    addPlaces(cell, s);
  }
  const float least_variance = kLeastSpread * kLeastSpread * full * full / 12.0F;
  const Planes planes = planesOf(s, least_variance);
  put((planes.slope < 0.0F).select(planes.slope, planes.slope / cell_m_), slope_, cell);
  put(planes.roughness, roughness_, cell);
}

}  // namespace spelunk::terrain
