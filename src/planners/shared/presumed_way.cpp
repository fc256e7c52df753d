#include "spelunk/planners/shared/presumed_way.h"

namespace spelunk::planners {

std::optional<map::ClosedPlace> placeAhead(const std::vector<Eigen::Vector3d>& way) {
  constexpr double kClosedRadius_m = 2.5;
  for (const Eigen::Vector3d& at : way)
    if ((at - way.front()).norm() >= kPresumedProgress_m)
      return map::ClosedPlace{at, kClosedRadius_m};
  if (way.empty()) return std::nullopt;
  return map::ClosedPlace{way.back(), kClosedRadius_m};
}

}  // namespace spelunk::planners
