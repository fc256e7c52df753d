#pragma once

#include <optional>

#include "spelunk/mission/endurance_guard.h"

namespace spelunk::mission {

/// What is left of the robot's endurance, seconds: as its battery reports it, else what the time
/// since take-off leaves of a full one.
class Endurance {
 public:
  enum class Place { kHome, kAway };

  /// `full_s`: on a full battery.
  Endurance(const EnduranceGuard::Rules& rules, double full_s)
      : guard_(rules), full_s_(full_s), at_start_s_(full_s) {}

  /// From the battery. False if it is no number of seconds: it is not used.
  bool report(double remaining_s);
  /// A mission begins. A robot at home can have been recharged.
  void begin(double now_s, Place place);
  /// Takes up what was left when a mission was saved.
  void takeUp(double remaining_s);
  void update(double now_s);

  [[nodiscard]] const EnduranceGuard& guard() const { return guard_; }

 private:
  EnduranceGuard guard_;
  double full_s_;
  double at_start_s_;  ///< Where no battery reports it.
  std::optional<double> started_s_;
  std::optional<double> reported_s_;
};

}  // namespace spelunk::mission
