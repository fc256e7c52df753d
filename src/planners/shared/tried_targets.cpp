#include "spelunk/planners/shared/tried_targets.h"

#include <algorithm>

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

}  // namespace

void TriedTargets::note(const Eigen::Vector3d& target, PathOutcome outcome,
                        const std::string& reason) {
  if (failuresAllowed(outcome) == 0) return;
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.outcome == outcome && (entry.target - target).norm() < radius_m_;
  });
  if (known == entries_.end()) {
    entries_.push_back({target, outcome, reason, 1, false});
  } else {
    ++known->failures;
    known->reason = reason;
  }
}

void TriedTargets::giveUp(const Eigen::Vector3d& target, const std::string& reason) {
  entries_.push_back({target, PathOutcome::kNone, reason, 1, true});
}

std::optional<std::string> TriedTargets::findRefusal(const Eigen::Vector3d& target) const {
  for (const Entry& entry : entries_) {
    const bool is_over = entry.is_given_up || entry.failures >= failuresAllowed(entry.outcome);
    if (is_over && (entry.target - target).norm() < radius_m_) {
      return "tried and given up: " + entry.reason;
    }
  }
  return std::nullopt;
}

}  // namespace spelunk::planners
