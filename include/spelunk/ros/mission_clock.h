#pragma once

#include <ros/time.h>

#include <optional>

namespace spelunk::bridge {

/// Mission time from ROS time: it begins at 0 with the first ROS time that is not 0. ROS time may
/// jump back (a simulator restarted, a bag replayed); mission time never does: after a jump it goes
/// on from where it was.
class MissionClock {
 public:
  /// Jumps back smaller than this are jitter between publishers and do not count.
  static constexpr double kJumpBack_s = 0.5;

  /// Notes that it is `now`. Returns how far the clock jumped back, seconds, if it did.
  std::optional<double> update(const ::ros::Time& now);

  [[nodiscard]] double toMission(const ::ros::Time& stamp) const {
    return last_s_ ? stamp.toSec() + offset_s_ : 0.0;
  }
  [[nodiscard]] ::ros::Time toRos(double mission_s) const;

 private:
  double offset_s_ = 0.0;
  std::optional<double> last_s_;
};

}  // namespace spelunk::bridge
