#include "spelunk/sim/battery.h"

#include <algorithm>

namespace spelunk::sim {
namespace {

constexpr double kJoulesPerWattHour = 3600.0;
constexpr double kTypicalSpeedShare = 0.7;  ///< Of the cruising speed, r.m.s., stops included.
constexpr double kMeanPowerWindow = 30.0;   ///< Seconds.

}  // namespace

Battery::Battery(const SimParams& params, const RobotModel& robot)
    : hover_power_w_(params.hover_power_w),
      motion_power_w_per_mps2_(params.motion_power_w_per_mps2),
      power_w_(params.hover_power_w) {
  const double typical_speed = kTypicalSpeedShare * robot.speed_max_mps;
  mean_power_w_ = hover_power_w_ + motion_power_w_per_mps2_ * typical_speed * typical_speed;
  capacity_j_ = params.battery_wh > 0.0 ? params.battery_wh * kJoulesPerWattHour
                                        : robot.endurance_s * mean_power_w_;
  energy_j_ = capacity_j_;
}

void Battery::draw(double step_s, double speed_mps) {
  power_w_ = hover_power_w_ + motion_power_w_per_mps2_ * speed_mps * speed_mps;
  energy_j_ = std::max(0.0, energy_j_ - power_w_ * step_s);
  mean_power_w_ += std::min(1.0, step_s / kMeanPowerWindow) * (power_w_ - mean_power_w_);
}

BatteryState Battery::state() const {
  return {energy_j_ / kJoulesPerWattHour, energy_j_ / capacity_j_, power_w_,
          energy_j_ / mean_power_w_};
}

}  // namespace spelunk::sim
