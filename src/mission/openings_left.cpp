#include "spelunk/mission/openings_left.h"

#include "spelunk/common/message_text.h"

namespace spelunk::mission {

std::vector<planners::RemainingTarget> targetsOf(const std::vector<map::Opening>& openings) {
  std::vector<planners::RemainingTarget> targets;
  for (const map::Opening& opening : openings) {
    const std::string why = "open to the outside at " + placeOf(opening.centre) +
                            ", nothing returns from there; " +
                            withNumber("%.1f m2", opening.area_m2);
    targets.push_back({opening.centre, 0.0, why});
  }
  return targets;
}

std::string countText(const std::vector<map::Opening>& openings) {
  if (openings.empty()) return "";
  return "; " + std::to_string(openings.size()) +
         (openings.size() == 1 ? " opening" : " openings") + " to the outside";
}

}  // namespace spelunk::mission
