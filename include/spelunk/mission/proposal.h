#pragma once

#include <optional>
#include <string>

#include "spelunk/mission/basis.h"
#include "spelunk/mission/plan_desk.h"
#include "spelunk/mission/plan_job.h"
#include "spelunk/mission/way_home.h"

namespace spelunk::mission {

/// What the mission makes of a planner's path, whatever the planner says of it.
struct Verdict {
  /// kReplaced if it is to be flown, else why not.
  planners::PathOutcome outcome = planners::PathOutcome::kRejectedUnsafe;
  std::string why;  ///< Why not, one sentence.
  Path path;        ///< To be flown, from the robot on; may be cut.
  Path rest;        ///< Of the planner's path, beyond that.

  [[nodiscard]] bool isAccepted() const { return outcome == planners::PathOutcome::kReplaced; }
};

/// Judges a planner's path that was found: it begins where the robot is or will be, has footing and
/// room all along, and a way home from its end fits the endurance; a local path may be cut for
/// that.
[[nodiscard]] Verdict judge(const RunningJob& job, const PlanOutcome& outcome, const Basis& basis,
                            const WayHome& way_home, double now_s);

/// The path of a second look on the way home, from the robot on; none if it is not worth turning
/// round: only what can be flown as a whole, with a known way home from its end, is.
[[nodiscard]] std::optional<Path> findAffordable(const RunningJob& job, const PlanOutcome& outcome,
                                                 const Basis& basis, const WayHome& way_home,
                                                 double now_s);

}  // namespace spelunk::mission
