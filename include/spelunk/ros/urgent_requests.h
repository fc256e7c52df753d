#pragma once

#include <mutex>
#include <optional>

#include "spelunk/mission/answer.h"
#include "spelunk/ros/mission_core.h"

namespace spelunk::bridge {

/// What people ask for and must not wait for.
enum class Urgent { kPause, kHome, kStop };

/// A request that came while something long (a file that is loaded, a big scan) held the mission:
/// the next tick carries it out before anything else, and no command is published before. A stop
/// stays in force against later requests.
class UrgentRequests {
 public:
  void ask(Urgent what);
  [[nodiscard]] std::optional<Urgent> take();
  /// Whether the robot is to hold until the waiting request is carried out.
  [[nodiscard]] bool holdsRobot() const;

 private:
  mutable std::mutex mutex_;
  std::optional<Urgent> waiting_;
};

/// Carries a request out, the mission locked; the answer is in the mission's frame.
mission::Answer carryOut(Urgent what, MissionCore& core);

/// What is answered to a request that waits for the mission.
[[nodiscard]] mission::Answer waitingAnswer(Urgent what);

}  // namespace spelunk::bridge
