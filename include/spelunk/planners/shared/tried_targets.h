#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners {

/// Remembers targets whose paths failed, so that none is tried again and again for the same reason.
/// A failure is believed for a minute, and twice as long after each one more: the map, the robot's
/// place and what stood in its way change. Only what was looked at in vain stays given up.
class TriedTargets {
 public:
  explicit TriedTargets(double radius_m) : radius_m_(radius_m) {}

  /// Notes what became of a path to `target`. Outcomes that are no failure are ignored. `time_s`:
  /// mission time.
  void note(const Eigen::Vector3d& target, PathOutcome outcome, const std::string& reason,
            double time_s);

  /// Lets those be tried again whose failure is no longer believed. How often they failed is kept.
  void age(double time_s);

  /// Gives a target up at once, whatever became of paths to it.
  void giveUp(const Eigen::Vector3d& target, const std::string& reason);

  /// Why paths to a place near `target` are not to be proposed again; empty if they may be.
  [[nodiscard]] std::optional<std::string> findRefusal(const Eigen::Vector3d& target) const;

 private:
  struct Entry {
    Eigen::Vector3d target;
    PathOutcome outcome;
    std::string reason;
    int failures = 0;
    bool is_given_up = false;
    bool is_aged = false;  ///< May be tried once more.
    double last_failed_s = 0.0;
  };
  double radius_m_;
  std::vector<Entry> entries_;
};

}  // namespace spelunk::planners
