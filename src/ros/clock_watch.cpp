#include "spelunk/ros/clock_watch.h"

#include <cstdio>

namespace spelunk::bridge {

std::string ClockWatch::check(const ::ros::Time& now, Source source, double real_s) {
  if (!since_s_ || now != last_) since_s_ = real_s;
  last_ = now;
  const double standing_s = real_s - *since_s_;
  if (source == Source::kSystem || standing_s < (now.isZero() ? kPatience_s : kStandstill_s))
    return "";
  char text[300];
  if (now.isZero()) {
    std::snprintf(text, sizeof(text),
                  "use_sim_time is true, but nothing has come on /clock for %.0f s: start the "
                  "simulator, play the bag with --clock, or set /use_sim_time to false and start "
                  "this node anew",
                  standing_s);
  } else {
    std::snprintf(text, sizeof(text),
                  "/clock has stood still at %.2f s for %.0f s: go on with the simulator or the "
                  "bag, or start it anew",
                  now.toSec(), standing_s);
  }
  return text;
}

}  // namespace spelunk::bridge
