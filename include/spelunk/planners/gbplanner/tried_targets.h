#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/planners/exploration_planner.h"

namespace spelunk::planners::gbplanner {

/// Remembers targets whose paths failed, so that none is tried again and again for the same reason.
class TriedTargets {
 public:
  explicit TriedTargets(double radius_m) : radius_m_(radius_m) {}

  /// Notes what became of a path to `target`. Outcomes that are no failure are ignored.
  void note(const Eigen::Vector3d& target, PathOutcome outcome, const std::string& reason);

  /// Why paths to a place near `target` are not to be proposed again; empty if they may be.
  [[nodiscard]] std::optional<std::string> findRefusal(const Eigen::Vector3d& target) const;

 private:
  struct Entry {
    Eigen::Vector3d target;
    PathOutcome outcome;
    std::string reason;
    int failures = 0;
  };
  double radius_m_;
  std::vector<Entry> entries_;
};

}  // namespace spelunk::planners::gbplanner
