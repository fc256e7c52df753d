#pragma once

#include <Eigen/Core>

#include "spelunk/sim/flight_controller.h"
#include "spelunk/sim/motion_reference.h"

namespace spelunk::sim {

enum class Power { kOn, kOff };

/// A robot's body with all that moves it.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  /// One fixed step from `time_s`. The robot steers towards `reference` by `estimate`, its
  /// odometry; without power nothing drives it.
  virtual void step(double step_s, double time_s, const BodyState& estimate,
                    MotionReference& reference, Power power) = 0;

  [[nodiscard]] virtual BodyState state() const = 0;

  /// Whether the body touched the mesh in the last step.
  [[nodiscard]] virtual bool isInContact() const = 0;

  /// Full extents of the body that collides.
  [[nodiscard]] virtual Eigen::Vector3d bodySize() const = 0;
};

}  // namespace spelunk::sim
