#include "spelunk/planners/shared/free_start.h"

#include "spelunk/planners/shared/free_place.h"

namespace spelunk::planners {
namespace {

constexpr double kReach_m = 0.6;  // the search may begin this far beside the robot
constexpr double kStep_m = 0.15;

}  // namespace

StartCheck checkStart(const PlanRequest& request, const FreeSpace& space) {
  const Eigen::Vector3d& position = request.pose.position;
  const Rejection here = space.at(position);
  if (here == Rejection::kNone) return {position, PlanStatus::kOk, ""};
  if (here == Rejection::kOutOfBounds)
    return {std::nullopt, PlanStatus::kOutOfBounds, "the start lies outside the bounds"};
  if (const auto near = PlaceFinder(kReach_m, kStep_m).find(position, space))
    return {near, PlanStatus::kOk, ""};
  if (here == Rejection::kNoGo)
    return {std::nullopt, PlanStatus::kOutOfBounds, "the start lies inside a no-go zone"};
  const char* reason =
      here == Rejection::kOccupied
          ? "the robot's box at the start touches an obstacle, and no place within "
            "0.6 m is free"
          : "the robot's box at the start touches unknown space, and no place "
            "within 0.6 m is known to be free";
  return {std::nullopt, PlanStatus::kStartBlocked, reason};
}

PlanResult refusedStart(const StartCheck& start) {
  PlanResult result;
  result.status = start.refusal;
  result.reason = start.reason;
  return result;
}

}  // namespace spelunk::planners
