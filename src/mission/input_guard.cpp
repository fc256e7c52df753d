#include "spelunk/mission/input_guard.h"

#include <cmath>

#include "spelunk/common/message_text.h"

namespace spelunk::mission {
namespace {

constexpr double kJumpSlack_m = 1.0;  // noise and corrections of an estimator
constexpr double kSpeedSlack = 3.0;   // times the robot's fastest motion
constexpr int kAgreeingReports = 5;

bool isFiniteState(const RobotState& state) {
  return std::isfinite(state.stamp_s) && isFinite(state.pose) && state.velocity.allFinite() &&
         std::isfinite(state.yaw_rate) && state.orientation.coeffs().allFinite();
}

}  // namespace

std::optional<std::string> InputGuard::faultAfter(const RobotState& before,
                                                  const RobotState& state) const {
  const double step = state.stamp_s - before.stamp_s;
  if (step < 0.0)
    return withNumber("odometry stamp jumped back by %.3f s: check the clocks", -step);
  const double jump = distance(before.pose, state.pose);
  if (jump > kJumpSlack_m + kSpeedSlack * speed_max_mps_ * step)
    return withNumber("odometry jumped by %.2f m: check the state estimation", jump);
  return std::nullopt;
}

std::optional<std::string> InputGuard::check(const RobotState& state) {
  if (!isFiniteState(state)) return "odometry holds NaN or infinity: check the state estimation";
  const auto fault = latest_ ? faultAfter(*latest_, state) : std::nullopt;
  if (!fault) {
    latest_ = state;
    doubtful_.reset();
    return std::nullopt;
  }
  agreeing_ = doubtful_ && !faultAfter(*doubtful_, state) ? agreeing_ + 1 : 0;
  doubtful_ = state;
  if (agreeing_ >= kAgreeingReports) {
    latest_ = state;
    doubtful_.reset();
  }
  return fault;
}

}  // namespace spelunk::mission
