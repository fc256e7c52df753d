#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/rng.h"
#include "spelunk/map/local_window.h"

namespace spelunk::planners {

/// Draws points uniformly from the known free volume of a box. The same distribution as drawing
/// from the whole box and dropping what is not free, without the many draws that galleries would
/// cost.
class FreeSampler {
 public:
  /// Copies what it needs; `window` is not kept.
  FreeSampler(const map::LocalWindow& window, const AxisAlignedBox& box);

  /// Empty if nothing in the box is free.
  [[nodiscard]] std::optional<Eigen::Vector3d> draw(Rng& rng) const;

 private:
  map::VoxelIndex origin_;
  map::VoxelIndex size_;
  double resolution_m_;
  std::vector<std::uint32_t> free_;  // offsets of free cells, ascending
};

}  // namespace spelunk::planners
