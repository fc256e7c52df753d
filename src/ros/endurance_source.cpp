#include "spelunk/ros/endurance_source.h"

#include <algorithm>

namespace spelunk::bridge {

EnduranceSource::EnduranceSource(double endurance_s, double time_limit_s)
    : endurance_s_(endurance_s), time_limit_s_(time_limit_s) {}

void EnduranceSource::start(double now_s) {
  if (!started_s_) started_s_ = now_s;
}

void EnduranceSource::onBattery(double remaining_s, double now_s) {
  battery_ = Reading{remaining_s, now_s};
}

double EnduranceSource::remaining(double now_s) const {
  const double flown_s = started_s_ ? std::max(0.0, now_s - *started_s_) : 0.0;
  const double budget_s = time_limit_s_ - flown_s;
  const double battery_s = battery_ ? battery_->remaining_s - std::max(0.0, now_s - battery_->at_s)
                                    : endurance_s_ - flown_s;
  return std::max(0.0, std::min(budget_s, battery_s));
}

}  // namespace spelunk::bridge
