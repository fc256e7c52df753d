#include "spelunk/planners/shared/free_sampler.h"

#include <algorithm>
#include <cstring>

namespace spelunk::planners {

FreeSampler::FreeSampler(const map::LocalWindow& window, const AxisAlignedBox& box)
    : origin_(window.origin()), size_(window.size()), resolution_m_(window.resolution()) {
  const auto free = static_cast<std::uint8_t>(map::Occupancy::kFree);
  const std::vector<std::uint8_t>& cells = window.cells();
  for (std::size_t i = 0; i < cells.size();) {
    std::uint64_t eight = 0;
    if (i + 8 <= cells.size()) std::memcpy(&eight, cells.data() + i, sizeof eight);
    if (i + 8 <= cells.size() && eight == 0) {
      i += 8;
      continue;
    }
    if (cells[i] == free) free_.push_back(static_cast<std::uint32_t>(i));
    ++i;
  }
  const auto outside = [&](std::uint32_t offset) {
    const auto nx = static_cast<std::uint32_t>(size_.x());
    const auto ny = static_cast<std::uint32_t>(size_.y());
    const map::VoxelIndex local(static_cast<int>(offset % nx), static_cast<int>(offset / nx % ny),
                                static_cast<int>(offset / nx / ny));
    return !box.contains(window.centreOf(origin_ + local));
  };
  free_.erase(std::remove_if(free_.begin(), free_.end(), outside), free_.end());
}

std::optional<Eigen::Vector3d> FreeSampler::draw(Rng& rng) const {
  if (free_.empty()) return std::nullopt;
  const std::uint32_t offset =
      free_[static_cast<std::size_t>(rng.below(static_cast<int>(free_.size())))];
  const auto nx = static_cast<std::uint32_t>(size_.x());
  const auto ny = static_cast<std::uint32_t>(size_.y());
  const Eigen::Vector3d corner(origin_.x() + static_cast<int>(offset % nx),
                               origin_.y() + static_cast<int>(offset / nx % ny),
                               origin_.z() + static_cast<int>(offset / nx / ny));
  const double x = rng.uniform();
  const double y = rng.uniform();
  const double z = rng.uniform();
  return (corner + Eigen::Vector3d(x, y, z)) * resolution_m_;
}

}  // namespace spelunk::planners
