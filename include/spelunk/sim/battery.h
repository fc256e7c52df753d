#pragma once

#include "spelunk/common/robot_model.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::sim {

/// Energy and power of a flying robot: hovering costs a constant power, motion adds speed squared.
class Battery {
 public:
  /// Without a capacity in `params`, one that lasts robot.endurance_s in typical flight, which is
  /// at 0.7 of the cruising speed on average.
  Battery(const SimParams& params, const RobotModel& robot);

  /// Draws for `step_s` of flight at `speed_mps`.
  void draw(double step_s, double speed_mps);

  [[nodiscard]] BatteryState state() const;
  [[nodiscard]] bool isEmpty() const { return energy_j_ <= 0.0; }

 private:
  double hover_power_w_;
  double motion_power_w_per_mps2_;
  double capacity_j_;
  double energy_j_;
  double power_w_;
  double mean_power_w_;  ///< Of the last half minute or so, typical flight before that.
};

}  // namespace spelunk::sim
