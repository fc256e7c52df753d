#include "spelunk/sim/rotors.h"

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::sim {
namespace {

/// Drag torque of a propeller per newton of thrust, metres; typical of 10 to 18 inch propellers.
constexpr double kDragTorqueRatio = 0.016;

/// The largest factor up to 1 that keeps base + factor * extra within [0, limit] everywhere.
double feasibleShare(const std::vector<double>& base, const std::vector<double>& extra,
                     double limit) {
  double share = 1.0;
  for (std::size_t k = 0; k < base.size(); ++k) {
    if (extra[k] > 0.0) share = std::min(share, (limit - base[k]) / extra[k]);
    if (extra[k] < 0.0) share = std::min(share, base[k] / -extra[k]);
  }
  return std::max(0.0, share);
}

}  // namespace

Rotors::Rotors(int count, double arm_m, double lag_s, double thrust_max_n)
    : lag_s_(lag_s), thrust_max_n_(thrust_max_n / count) {
  require(count == 4 || count == 6, "Rotors: 4 or 6 rotors");
  require(arm_m > 0.0 && lag_s >= 0.0 && thrust_max_n > 0.0, "Rotors: sizes must be positive");
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * M_PI * (k + 0.5) / count;
    arms_.push_back({arm_m * std::cos(angle), arm_m * std::sin(angle), k % 2 == 0 ? 1.0 : -1.0});
  }
  commands_.assign(arms_.size(), 0.0);
  thrusts_.assign(arms_.size(), 0.0);
}

void Rotors::command(const Wrench& wanted) {
  // Pseudo-inverse of the mixing matrix: its rows are orthogonal for rotors evenly on a circle.
  const auto n = static_cast<double>(arms_.size());
  const double arm_squared = arms_[0].x_m * arms_[0].x_m + arms_[0].y_m * arms_[0].y_m;
  std::vector<double> tilt(arms_.size());
  std::vector<double> yaw(arms_.size());
  for (std::size_t k = 0; k < arms_.size(); ++k) {
    tilt[k] = 2.0 / (n * arm_squared) *
              (arms_[k].y_m * wanted.torque_nm.x() - arms_[k].x_m * wanted.torque_nm.y());
    yaw[k] = arms_[k].spin * wanted.torque_nm.z() / (n * kDragTorqueRatio);
  }
  const auto [least, most] = std::minmax_element(tilt.begin(), tilt.end());
  const double spread = *most - *least;
  const double tilt_share = spread > thrust_max_n_ ? thrust_max_n_ / spread : 1.0;
  const double collective =
      std::clamp(wanted.thrust_n / n, -tilt_share * *least,
                 std::max(-tilt_share * *least, thrust_max_n_ - tilt_share * *most));
  for (std::size_t k = 0; k < arms_.size(); ++k) commands_[k] = collective + tilt_share * tilt[k];
  const double yaw_share = feasibleShare(commands_, yaw, thrust_max_n_);
  for (std::size_t k = 0; k < arms_.size(); ++k)
    commands_[k] = std::clamp(commands_[k] + yaw_share * yaw[k], 0.0, thrust_max_n_);
}

void Rotors::advance(double step_s) {
  const double share = lag_s_ > 0.0 ? -std::expm1(-step_s / lag_s_) : 1.0;
  for (std::size_t k = 0; k < thrusts_.size(); ++k)
    thrusts_[k] += share * (commands_[k] - thrusts_[k]);
}

void Rotors::spinUp(double thrust_n) {
  const double each = std::min(thrust_n / static_cast<double>(arms_.size()), thrust_max_n_);
  commands_.assign(arms_.size(), each);
  thrusts_ = commands_;
}

Wrench Rotors::wrench() const {
  Wrench sum;
  for (std::size_t k = 0; k < arms_.size(); ++k) {
    sum.thrust_n += thrusts_[k];
    sum.torque_nm += thrusts_[k] *
                     Eigen::Vector3d(arms_[k].y_m, -arms_[k].x_m, arms_[k].spin * kDragTorqueRatio);
  }
  return sum;
}

}  // namespace spelunk::sim
