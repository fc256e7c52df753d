#pragma once

namespace spelunk::bridge {

/// Keeps simulated time at a multiple of wall time. A backlog larger than kBacklog_s of wall time
/// is dropped, so that a slow machine runs late instead of racing afterwards.
class Pacer {
 public:
  static constexpr double kBacklog_s = 0.1;

  /// Simulated seconds a wall second.
  explicit Pacer(double speed_factor) : speed_factor_(speed_factor) {}

  /// Wall seconds to sleep before `simulated_s` may be shown, at wall time `wall_s`; 0 if late.
  [[nodiscard]] double pause(double simulated_s, double wall_s);

 private:
  double speed_factor_;
  bool has_origin_ = false;
  double origin_simulated_s_ = 0.0;
  double origin_wall_s_ = 0.0;
};

}  // namespace spelunk::bridge
