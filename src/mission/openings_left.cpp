#include "spelunk/mission/openings_left.h"

#include <cstdio>

namespace spelunk::mission {

std::vector<planners::RemainingTarget> targetsOf(const std::vector<map::Opening>& openings) {
  std::vector<planners::RemainingTarget> targets;
  for (const map::Opening& opening : openings) {
    const Eigen::Vector3d& at = opening.centre;
    char why[160];
    std::snprintf(why, sizeof why,
                  "open to the outside at (%.1f, %.1f, %.1f), nothing returns from there; %.1f m2",
                  at.x(), at.y(), at.z(), opening.area_m2);
    targets.push_back({at, 0.0, why});
  }
  return targets;
}

std::string countText(const std::vector<map::Opening>& openings) {
  if (openings.empty()) return "";
  return "; " + std::to_string(openings.size()) +
         (openings.size() == 1 ? " opening" : " openings") + " to the outside";
}

}  // namespace spelunk::mission
