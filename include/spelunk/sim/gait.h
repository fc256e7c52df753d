#pragma once

#include <cstddef>

#include "spelunk/sim/walker_params.h"

namespace spelunk::sim {

/// The clock of the legs: when each is on the ground and when it swings. Trot swings diagonal
/// pairs, walk one leg after the other (left hind, left front, right hind, right front).
class Gait {
 public:
  explicit Gait(const WalkerParams& params);

  void advance(double step_s);

  /// Back to the instant before the first leg swings.
  void restart();

  [[nodiscard]] bool isStance(std::size_t leg) const { return phaseOf(leg) < duty_; }

  /// Seconds until the leg's swing ends; 0 in stance.
  [[nodiscard]] double swingLeft(std::size_t leg) const;

  [[nodiscard]] double swingTime() const { return (1.0 - duty_) * period_s_; }
  [[nodiscard]] double stanceTime() const { return duty_ * period_s_; }

 private:
  [[nodiscard]] double phaseOf(std::size_t leg) const;  ///< 0 at touchdown, 1 at the next.

  double period_s_;
  double duty_;
  bool is_walk_;
  double phase_ = 0.0;
};

}  // namespace spelunk::sim
