#include "spelunk/mission/endurance.h"

#include <algorithm>
#include <cmath>

namespace spelunk::mission {

bool Endurance::report(double remaining_s) {
  if (!std::isfinite(remaining_s) || remaining_s < 0.0) return false;
  reported_s_ = remaining_s;
  return true;
}

void Endurance::begin(double now_s, Place place) {
  if (started_s_) return;
  started_s_ = now_s;
  if (place == Place::kHome) at_start_s_ = full_s_;
}

void Endurance::takeUp(double remaining_s) {
  at_start_s_ = std::min(full_s_, remaining_s);
  started_s_.reset();
}

void Endurance::update(double now_s) {
  const double flown_s = started_s_ ? now_s - *started_s_ : 0.0;
  guard_.report(reported_s_.value_or(std::max(0.0, at_start_s_ - flown_s)));
}

}  // namespace spelunk::mission
