#include "spelunk/ros/mission_clock.h"

#include <algorithm>

namespace spelunk::bridge {

std::optional<double> MissionClock::update(const ::ros::Time& now) {
  if (now.isZero()) return std::nullopt;  // No clock yet.
  const double now_s = now.toSec();
  if (!last_s_) offset_s_ = -now_s;
  const double back_s = last_s_ ? *last_s_ - now_s : 0.0;
  if (back_s >= kJumpBack_s) {
    offset_s_ += back_s;
    last_s_ = now_s;
    return back_s;
  }
  last_s_ = std::max(now_s, last_s_.value_or(now_s));
  return std::nullopt;
}

::ros::Time MissionClock::toRos(double mission_s) const {
  const double ros_s = std::max(0.0, mission_s - offset_s_);
  return ::ros::Time(ros_s);
}

}  // namespace spelunk::bridge
