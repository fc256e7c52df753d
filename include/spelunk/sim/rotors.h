#pragma once

#include <Eigen/Core>
#include <vector>

namespace spelunk::sim {

/// What a set of rotors can do together, in the base frame.
struct Wrench {
  double thrust_n = 0.0;  ///< Along base z.
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();
};

/// Equal rotors evenly on a circle around the centre of mass, thrust along base z, neighbours
/// turning in opposite directions. Each follows its command with a first-order lag and can only
/// push, up to its limit.
class Rotors {
 public:
  /// `count` is 4 or 6; `thrust_max_n` is that of all rotors together.
  Rotors(int count, double arm_m, double lag_s, double thrust_max_n);

  /// Commands the thrusts nearest to `wanted`. Where the limits are in the way, yaw torque is given
  /// up first, then the collective thrust, roll and pitch last: a robot that stays upright
  /// recovers.
  void command(const Wrench& wanted);

  /// All rotors follow their commands for `step_s`.
  void advance(double step_s);

  /// Sets thrusts and commands to hover at `thrust_n` in all.
  void spinUp(double thrust_n);

  [[nodiscard]] Wrench wrench() const;
  [[nodiscard]] const std::vector<double>& thrusts() const { return thrusts_; }

 private:
  struct Arm {
    double x_m;
    double y_m;
    double spin;  ///< +1 or -1: sign of the drag torque about base z.
  };
  std::vector<Arm> arms_;
  std::vector<double> commands_;
  std::vector<double> thrusts_;
  double lag_s_;
  double thrust_max_n_;  ///< Of one rotor.
};

}  // namespace spelunk::sim
