#include "spelunk/map/clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "spelunk/common/contract.h"
#include "voxel_key.h"

namespace spelunk::map {
namespace {

/// Squared distances in voxels, axis by axis; at most `reach` voxels matter on each axis. `Cell` is
/// the narrowest type that holds 3 * (reach + 1)^2, so that more fit into a register.
template <class Cell>
class SquaredDistances {
 public:
  SquaredDistances(const LocalWindow& window, int reach)
      : size_(window.size()),
        reach_(reach),
        far_(static_cast<Cell>((reach + 1) * (reach + 1))),
        cells_(window.cellCount()) {
    alongZ(window);
    const auto column = static_cast<std::size_t>(size_.z());
    const std::size_t plane = column * static_cast<std::size_t>(size_.x());
    for (std::size_t y = 0; y < static_cast<std::size_t>(size_.y()); ++y)
      alongLines(y * plane, column, size_.x(), column);
    alongLines(0, plane, size_.y(), plane);
  }
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

 private:
  void alongZ(const LocalWindow& window) {
    const std::ptrdiff_t length = size_.z();
    for (std::size_t start = 0; start < cells_.size(); start += static_cast<std::size_t>(length)) {
      const std::uint8_t* from = window.cells() + start;
      Cell* to = cells_.data() + start;
      const auto squared = [&](int steps) {
        return steps > reach_ ? far_ : static_cast<Cell>(steps * steps);
      };
      int steps = reach_ + 1;
      const auto pass = [&](std::ptrdiff_t z) {
        steps = from[z] == static_cast<std::uint8_t>(Occupancy::kOccupied)
                    ? 0
                    : std::min(steps + 1, reach_ + 1);
        return squared(steps);
      };
      for (std::ptrdiff_t z = 0; z < length; ++z) to[z] = pass(z);
      steps = reach_ + 1;
      for (std::ptrdiff_t z = length - 1; z >= 0; --z) to[z] = std::min(to[z], pass(z));
    }
  }

  /// Lower envelope over `count` lines of `width` cells, `stride` apart: the distance along the
  /// lines' order is added to what the lines hold.
  void alongLines(std::size_t start, std::size_t width, int count, std::size_t stride) {
    const std::vector<Cell> before(
        cells_.begin() + static_cast<std::ptrdiff_t>(start),
        cells_.begin() + static_cast<std::ptrdiff_t>(
                             start + stride * static_cast<std::size_t>(count - 1) + width));
    for (int line = 0; line < count; ++line) {
      Cell* to = cells_.data() + start + stride * static_cast<std::size_t>(line);
      const int first = std::max(0, line - reach_);
      const int last = std::min(count - 1, line + reach_);
      for (int other = first; other <= last; ++other) {
        const Cell* from = before.data() + stride * static_cast<std::size_t>(other);
        const auto added = static_cast<Cell>((other - line) * (other - line));
        for (std::size_t i = 0; i < width; ++i)
          to[i] = std::min<Cell>(to[i], static_cast<Cell>(from[i] + added));
      }
    }
  }

  VoxelIndex size_;
  int reach_;
  Cell far_;
  std::vector<Cell> cells_;
};

template <class Cell>
std::vector<float> distances(const LocalWindow& window, int reach, double limit_m) {
  const SquaredDistances<Cell> squared(window, reach);
  std::vector<float> by_square(static_cast<std::size_t>((reach + 1) * (reach + 1)) + 1);
  for (std::size_t i = 0; i < by_square.size(); ++i)
    by_square[i] = static_cast<float>(
        std::min(limit_m, std::sqrt(static_cast<double>(i)) * window.resolution()));
  std::vector<float> result(squared.cells().size());
  std::transform(squared.cells().begin(), squared.cells().end(), result.begin(),
                 [&](Cell cell) { return by_square[static_cast<std::size_t>(cell)]; });
  return result;
}

}  // namespace

ClearanceField::ClearanceField(const LocalWindow& window, double limit_m)
    : origin_(window.origin()),
      size_(window.size()),
      resolution_m_(window.resolution()),
      limit_m_(limit_m) {
  require(std::isfinite(limit_m) && limit_m > 0.0, "ClearanceField: limit must be positive");
  const double reach = std::ceil(limit_m / resolution_m_);
  require(reach < 10000.0, "ClearanceField: limit is more than 10000 voxels");
  const int steps = static_cast<int>(reach);
  constexpr int kMaxNarrow = 103;  // 3 * 104^2 < 32768
  distance_m_ = steps <= kMaxNarrow ? distances<std::int16_t>(window, steps, limit_m)
                                    : distances<std::int32_t>(window, steps, limit_m);
}

double ClearanceField::at(const Eigen::Vector3d& point) const {
  const VoxelIndex local = voxelOf(point, 1.0 / resolution_m_) - origin_;
  if ((local.array() < 0).any() || (local.array() >= size_.array()).any()) return limit_m_;
  const auto column = static_cast<std::size_t>(size_.z());
  return distance_m_[static_cast<std::size_t>(local.z()) +
                     column * (static_cast<std::size_t>(local.x()) +
                               static_cast<std::size_t>(size_.x()) *
                                   static_cast<std::size_t>(local.y()))];
}

}  // namespace spelunk::map
