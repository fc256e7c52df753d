#pragma once

namespace spelunk::mission {

/// The arithmetic of coming home: what may be spent, and what a way home costs.
class EnduranceGuard {
 public:
  struct Rules {
    double reserve_s = 20.0;       ///< Must be left at home,
    double reserve_percent = 3.0;  ///< and so much of the full endurance; the larger counts.
    double pessimism = 1.25;       ///< Travel times are taken this much longer.
  };
  explicit EnduranceGuard(const Rules& rules) : rules_(rules) {}

  /// Reports the remaining endurance. The largest report counts as the full endurance.
  void report(double remaining_s);

  [[nodiscard]] double remaining() const { return remaining_s_; }
  [[nodiscard]] double reserve() const;
  [[nodiscard]] double pessimistic(double travel_s) const { return rules_.pessimism * travel_s; }

  /// remaining - reserve - pessimistic way home; negative: the invariant is broken.
  [[nodiscard]] double margin(double way_home_s) const;

  /// The same, at the end of a path flown first.
  [[nodiscard]] double marginAfter(double path_s, double way_home_s) const;

  /// The endurance a planner may dispose of from a moment `ahead_s` from now on, on the planner's
  /// own, not pessimistic, travel times; at least 0.
  [[nodiscard]] double disposable(double ahead_s) const;

 private:
  Rules rules_;
  double remaining_s_ = 0.0;
  double full_s_ = 0.0;
};

}  // namespace spelunk::mission
