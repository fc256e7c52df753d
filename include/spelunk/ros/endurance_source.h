#pragma once

#include <optional>

namespace spelunk::bridge {

/// How long the robot can still be under way: what the battery says where there is one, and never
/// more than the time budget. Mission time.
class EnduranceSource {
 public:
  /// `endurance_s`: the robot's on a full battery. `time_limit_s`: the budget of the mission.
  EnduranceSource(double endurance_s, double time_limit_s);

  /// The budget starts to run; later calls change nothing.
  void start(double now_s);

  void onBattery(double remaining_s, double now_s);

  /// A battery that was heard before but not for long is taken to run down second by second.
  [[nodiscard]] double remaining(double now_s) const;

  [[nodiscard]] bool hasBattery() const { return battery_.has_value(); }

 private:
  struct Reading {
    double remaining_s = 0.0;
    double at_s = 0.0;
  };
  double endurance_s_;
  double time_limit_s_;
  std::optional<double> started_s_;
  std::optional<Reading> battery_;
};

}  // namespace spelunk::bridge
