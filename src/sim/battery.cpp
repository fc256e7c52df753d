#include "spelunk/sim/battery.h"

#include <algorithm>

namespace spelunk::sim {
namespace {

constexpr double kJoulesPerWattHour = 3600.0;
constexpr double kMeanPowerWindow = 30.0;  ///< Seconds.

}  // namespace

PowerModel flightPower(const SimParams& params) {
  return {params.hover_power_w, 0.0, params.motion_power_w_per_mps2};
}

PowerModel walkingPower(const WalkerParams& params) {
  return {params.standing_power_w, params.walking_power_w_per_mps, 0.0};
}

Battery::Battery(const PowerModel& power, double capacity_wh, const RobotModel& robot)
    : model_(power), power_w_(power.rest_w) {
  mean_power_w_ = powerAt(robot.speed_max_mps);
  capacity_j_ =
      capacity_wh > 0.0 ? capacity_wh * kJoulesPerWattHour : robot.endurance_s * mean_power_w_;
  energy_j_ = capacity_j_;
}

double Battery::powerAt(double speed_mps) const {
  return model_.rest_w + model_.per_mps_w * speed_mps + model_.per_mps2_w * speed_mps * speed_mps;
}

void Battery::draw(double step_s, double speed_mps) {
  power_w_ = powerAt(speed_mps);
  energy_j_ = std::max(0.0, energy_j_ - power_w_ * step_s);
  mean_power_w_ += std::min(1.0, step_s / kMeanPowerWindow) * (power_w_ - mean_power_w_);
}

BatteryState Battery::state() const {
  return {energy_j_ / kJoulesPerWattHour, energy_j_ / capacity_j_, power_w_,
          energy_j_ / mean_power_w_};
}

}  // namespace spelunk::sim
