#pragma once

#include <ros/time.h>

#include <optional>
#include <string>

namespace spelunk::bridge {

/// Notices a ROS clock that does not run: with use_sim_time it stands until somebody sends /clock.
/// Not thread-safe.
class ClockWatch {
 public:
  static constexpr double kPatience_s = 1.5;    ///< Real seconds without a clock until it is said.
  static constexpr double kStandstill_s = 5.0;  ///< Real seconds at the same time until it is said.

  enum class Source { kSystem, kSimulated };

  /// `now`: the ROS clock, which comes from /clock if simulated. `real_s`: seconds of a clock that
  /// always runs. What is wrong and the remedy, one sentence; empty if the clock runs.
  [[nodiscard]] std::string check(const ::ros::Time& now, Source source, double real_s);

 private:
  ::ros::Time last_;
  std::optional<double> since_s_;  ///< Real time since when it has been `last_`.
};

}  // namespace spelunk::bridge
