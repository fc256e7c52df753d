#include "spelunk/sim/gait.h"

#include <array>
#include <cmath>

#include "spelunk/sim/leg_kinematics.h"

namespace spelunk::sim {
namespace {

constexpr std::array<double, kLegs> kTrotOffsets{0.0, 0.5, 0.5, 0.0};
constexpr std::array<double, kLegs> kWalkOffsets{0.75, 0.25, 0.0, 0.5};

}  // namespace

Gait::Gait(const WalkerParams& params)
    : period_s_(params.gait_period_s), duty_(params.duty_factor), is_walk_(params.gait == "walk") {
  restart();
}

void Gait::restart() { phase_ = duty_ - 0.01; }

void Gait::advance(double step_s) {
  phase_ += step_s / period_s_;
  phase_ -= std::floor(phase_);
}

double Gait::phaseOf(std::size_t leg) const {
  const double phase = phase_ + (is_walk_ ? kWalkOffsets : kTrotOffsets)[leg];
  return phase - std::floor(phase);
}

double Gait::swingLeft(std::size_t leg) const {
  return isStance(leg) ? 0.0 : (1.0 - phaseOf(leg)) * period_s_;
}

}  // namespace spelunk::sim
