#pragma once

#include <optional>
#include <string>

#include "spelunk/common/pose.h"

namespace spelunk::mission {

/// Tells good odometry from bad: NaN, stamps that run backwards, jumps of metres. After a jump the
/// new place is believed once several reports in a row agree on it.
class InputGuard {
 public:
  explicit InputGuard(double speed_max_mps) : speed_max_mps_(speed_max_mps) {}

  /// None if the report is good and taken up; else what is wrong with it.
  [[nodiscard]] std::optional<std::string> check(const RobotState& state);

  [[nodiscard]] const std::optional<RobotState>& latest() const { return latest_; }

 private:
  [[nodiscard]] std::optional<std::string> faultAfter(const RobotState& before,
                                                      const RobotState& state) const;

  double speed_max_mps_;
  std::optional<RobotState> latest_;    ///< The newest good report.
  std::optional<RobotState> doubtful_;  ///< The newest report that contradicts it.
  int agreeing_ = 0;                    ///< Reports in a row that agree with the doubtful one.
};

}  // namespace spelunk::mission
