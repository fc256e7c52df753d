#pragma once

#include "spelunk/common/robot_model.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::sim {

/// What a robot draws: at rest, and more with its speed.
struct PowerModel {
  double rest_w = 350.0;
  double per_mps_w = 0.0;    ///< Times speed.
  double per_mps2_w = 12.0;  ///< Times speed squared.
};

/// The power of a flying robot.
[[nodiscard]] PowerModel flightPower(const SimParams& params);

/// The power of a walking robot.
[[nodiscard]] PowerModel walkingPower(const WalkerParams& params);

/// Energy of a robot.
class Battery {
 public:
  /// With `capacity_wh` 0, a capacity that lasts robot.endurance_s at robot.speed_max_mps.
  Battery(const PowerModel& power, double capacity_wh, const RobotModel& robot);

  /// Draws for `step_s` of motion at `speed_mps`.
  void draw(double step_s, double speed_mps);

  [[nodiscard]] BatteryState state() const;
  [[nodiscard]] bool isEmpty() const { return energy_j_ <= 0.0; }

 private:
  [[nodiscard]] double powerAt(double speed_mps) const;

  PowerModel model_;
  double power_w_;
  double mean_power_w_;
  double capacity_j_;
  double energy_j_;
};

}  // namespace spelunk::sim
