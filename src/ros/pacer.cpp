#include "spelunk/ros/pacer.h"

#include <algorithm>

namespace spelunk::bridge {

double Pacer::pause(double simulated_s, double wall_s) {
  if (!has_origin_) {
    has_origin_ = true;
    origin_simulated_s_ = simulated_s;
    origin_wall_s_ = wall_s;
  }
  const double due_s = origin_wall_s_ + (simulated_s - origin_simulated_s_) / speed_factor_;
  if (wall_s - due_s > kBacklog_s) {
    origin_simulated_s_ = simulated_s;
    origin_wall_s_ = wall_s;
  }
  return std::max(0.0, due_s - wall_s);
}

}  // namespace spelunk::bridge
