#include "spelunk/planners/shared/tried_targets.h"

#include <algorithm>
#include <cmath>

namespace spelunk::planners {
namespace {

/// Failures after which a target is given up; 0: the outcome is none. A way that was cut by a newly
/// seen obstacle deserves another look, for the map knows more now; a refusal does not.
int failuresAllowed(PathOutcome outcome) {
  switch (outcome) {
    case PathOutcome::kNone:
    case PathOutcome::kReached:
    case PathOutcome::kReplaced:
      return 0;
    case PathOutcome::kBlocked:
    case PathOutcome::kDeviated:
      return 3;
    case PathOutcome::kRejectedUnsafe:
      return 2;
    case PathOutcome::kRejectedBudget:
      return 1;
  }
  return 0;
}

/// A robot at 0.5 m/s has left the room meanwhile, and its map knows more.
constexpr double kBelieved_s = 60.0;

}  // namespace

void TriedTargets::note(const Eigen::Vector3d& target, PathOutcome outcome,
                        const std::string& reason, double time_s) {
  if (failuresAllowed(outcome) == 0) return;
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.outcome == outcome && (entry.target - target).norm() < radius_m_;
  });
  if (known == entries_.end()) {
    entries_.push_back({target, outcome, reason, 1, false, false, time_s});
  } else {
    ++known->failures;
    known->reason = reason;
    known->is_aged = false;
    known->last_failed_s = time_s;
  }
}

void TriedTargets::giveUp(const Eigen::Vector3d& target, const std::string& reason) {
  entries_.push_back({target, PathOutcome::kNone, reason, 1, true, false, 0.0});
}

void TriedTargets::age(double time_s) {
  for (Entry& entry : entries_) {
    if (entry.is_given_up) continue;
    const int beyond = std::max(0, entry.failures - failuresAllowed(entry.outcome));
    entry.is_aged = time_s - entry.last_failed_s > std::ldexp(kBelieved_s, beyond);
  }
}

std::optional<std::string> TriedTargets::findRefusal(const Eigen::Vector3d& target) const {
  for (const Entry& entry : entries_) {
    const bool is_over =
        entry.is_given_up || (!entry.is_aged && entry.failures >= failuresAllowed(entry.outcome));
    if (is_over && (entry.target - target).norm() < radius_m_) {
      return "tried and given up: " + entry.reason;
    }
  }
  return std::nullopt;
}

}  // namespace spelunk::planners
