#include "spelunk/mission/proposal.h"

#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/navigation/trajectory_timing.h"

namespace spelunk::mission {
namespace {

using planners::PathOutcome;
using planners::PlanStatus;

constexpr double kShortestCut_m = 2.0;  // less is not worth the way
/// A robot at rest stands where its plan begins, but for the drift of its controller.
constexpr double kStartGap_m = 0.5;

bool beginsWhereTheRobotIs(const RunningJob& job, const Basis& basis, double now_s) {
  if (basis.flight.active()) return job.isInTime(now_s);
  return distance(basis.watch.pose(), job.pose) < kStartGap_m;
}

Verdict refused(PathOutcome outcome, std::string why) { return {outcome, std::move(why), {}, {}}; }

}  // namespace

Verdict judge(const RunningJob& job, const PlanOutcome& outcome, const Basis& basis,
              const WayHome& way_home, double now_s) {
  const Path& path = outcome.plan.path;
  if (!beginsWhereTheRobotIs(job, basis, now_s))
    return refused(PathOutcome::kNone,  // no fault of the path
                   "the plan came too late: its start lies behind the robot");
  if (!basis.space.isWalkable(path))
    return refused(PathOutcome::kRejectedUnsafe, "refused the planner's path: no footing along it");
  const auto check = basis.space.checkProposal(path);
  if (!check.isFree())
    return refused(PathOutcome::kRejectedUnsafe,
                   "refused the planner's path: " + std::string(navigation::toText(check.fault)) +
                       (check.zone.empty() ? "" : " '" + check.zone + "'"));
  const Path whole = basis.flight.joined(path, job.takes_over_s, basis.watch.pose(), now_s);
  const bool has_home = outcome.home.status == PlanStatus::kOk;
  const double length = lengthOf(whole);
  const double affordable = way_home.affordableLength(
      whole, has_home ? std::optional<Path>(outcome.home.path) : std::nullopt);
  const bool may_be_cut = outcome.plan.kind == planners::PathKind::kLocal;
  if (affordable < length && (!may_be_cut || affordable < kShortestCut_m))
    return refused(PathOutcome::kRejectedBudget,
                   "refused the planner's path: no way home from its end fits the endurance");
  return {PathOutcome::kReplaced, "", slice(whole, 0.0, affordable),
          slice(whole, affordable, length)};
}

std::optional<Path> findAffordable(const RunningJob& job, const PlanOutcome& outcome,
                                   const Basis& basis, const WayHome& way_home, double now_s) {
  const bool is_usable = outcome.plan.status == PlanStatus::kOk &&
                         outcome.home.status == PlanStatus::kOk && basis.flight.active() &&
                         job.isInTime(now_s);
  if (!is_usable || !basis.space.isWalkable(outcome.plan.path) ||
      !basis.space.checkProposal(outcome.plan.path).isFree() ||
      !basis.space.isClear(outcome.home.path, basis.robot.box_m))
    return std::nullopt;
  Path whole = basis.flight.joined(outcome.plan.path, job.takes_over_s, basis.watch.pose(), now_s);
  const double there_s = way_home.travelTime(whole);
  const double home_s = way_home.travelTime(outcome.home.path);
  if (basis.endurance.guard().marginAfter(there_s, home_s) < 0.0) return std::nullopt;
  return whole;
}

}  // namespace spelunk::mission
