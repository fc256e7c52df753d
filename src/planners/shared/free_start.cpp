#include "spelunk/planners/shared/free_start.h"

#include <algorithm>
#include <vector>

namespace spelunk::planners {
namespace {

constexpr double kReach = 0.6;  // metres the search may begin beside the robot
constexpr int kSteps = 4;       // of the grid of candidates, each way

std::vector<Eigen::Vector3d> offsetsByDistance() {
  std::vector<Eigen::Vector3d> offsets;
  for (int x = -kSteps; x <= kSteps; ++x) {
    for (int y = -kSteps; y <= kSteps; ++y) {
      for (int z = -kSteps; z <= kSteps; ++z) {
        const Eigen::Vector3d offset = Eigen::Vector3d(x, y, z) * (kReach / kSteps);
        if (offset.norm() <= kReach) offsets.push_back(offset);
      }
    }
  }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  return offsets;
}

}  // namespace

StartCheck checkStart(const PlanRequest& request, const FreeSpace& space) {
  const Eigen::Vector3d& position = request.pose.position;
  const Rejection here = space.at(position);
  if (here == Rejection::kNone) return {position, PlanStatus::kOk, ""};
  if (here == Rejection::kOutOfBounds)
    return {std::nullopt, PlanStatus::kOutOfBounds, "the start lies outside the bounds"};
  for (const Eigen::Vector3d& offset : offsetsByDistance()) {
    if (space.at(position + offset) == Rejection::kNone)
      return {position + offset, PlanStatus::kOk, ""};
  }
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
