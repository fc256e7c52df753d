#include "spelunk/planners/shared/free_place.h"

#include <algorithm>
#include <cmath>

namespace spelunk::planners {

PlaceFinder::PlaceFinder(double reach_m, double step_m) {
  const int steps = static_cast<int>(std::floor(reach_m / step_m + 1e-9));
  for (int x = -steps; x <= steps; ++x)
    for (int y = -steps; y <= steps; ++y)
      for (int z = -steps; z <= steps; ++z) {
        const Eigen::Vector3d offset = Eigen::Vector3d(x, y, z) * step_m;
        if (offset.norm() <= reach_m + 1e-9) offsets_.push_back(offset);
      }
  std::stable_sort(offsets_.begin(), offsets_.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
}

std::optional<Eigen::Vector3d> PlaceFinder::find(const Eigen::Vector3d& point,
                                                 const FreeSpace& space) const {
  for (const Eigen::Vector3d& offset : offsets_)
    if (space.at(point + offset) == Rejection::kNone) return point + offset;
  return std::nullopt;
}

std::optional<Eigen::Vector3d> PlaceFinder::findRoomy(const Eigen::Vector3d& point,
                                                      const KnownSpace& space) const {
  std::optional<Eigen::Vector3d> nearest;
  for (const Eigen::Vector3d& offset : offsets_) {
    const Eigen::Vector3d place = point + offset;
    if (space.free().at(place) != Rejection::kNone) continue;
    if (space.isRoomy(place)) return place;
    if (!nearest) nearest = place;
  }
  return nearest;
}

}  // namespace spelunk::planners
