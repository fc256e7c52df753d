#include "spelunk/mission/endurance_guard.h"

#include <algorithm>

namespace spelunk::mission {

void EnduranceGuard::report(double remaining_s) {
  remaining_s_ = remaining_s;
  full_s_ = std::max(full_s_, remaining_s);
}

double EnduranceGuard::reserve() const {
  return std::max(rules_.reserve_s, 0.01 * rules_.reserve_percent * full_s_);
}

double EnduranceGuard::margin(double way_home_s) const {
  return remaining_s_ - reserve() - pessimistic(way_home_s);
}

double EnduranceGuard::marginAfter(double path_s, double way_home_s) const {
  return margin(way_home_s) - path_s;
}

double EnduranceGuard::disposable(double ahead_s) const {
  return std::max(0.0, (remaining_s_ - reserve() - ahead_s) / rules_.pessimism);
}

}  // namespace spelunk::mission
