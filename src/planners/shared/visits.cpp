#include "spelunk/planners/shared/visits.h"

#include <algorithm>

namespace spelunk::planners {
namespace {

constexpr double kThere_m = 0.75;  // poses of the trail are about a metre apart
constexpr std::size_t kExpectedMax = 16;
constexpr std::size_t kStartsMax = 16;
constexpr double kLook_s = 2.0;  // plans begin ahead of the robot, which then has to look around

}  // namespace

bool wasVisited(const std::vector<StampedPose>& trail, const Eigen::Vector3d& place,
                double radius_m) {
  return std::any_of(trail.begin(), trail.end(), [&](const StampedPose& stamped) {
    return (stamped.pose.position - place).norm() < radius_m;
  });
}

void Visits::expect(const Visit& visit) {
  expected_.push_back(visit);
  if (expected_.size() > kExpectedMax) expected_.erase(expected_.begin());
}

void Visits::noteStart(const PlanRequest& request, PathOutcome last) {
  const bool left_its_way = last == PathOutcome::kBlocked || last == PathOutcome::kDeviated;
  if (left_its_way) starts_.clear();
  starts_.push_back({request.time_s, request.pose});
  if (starts_.size() > kStartsMax) starts_.erase(starts_.begin());
}

bool Visits::isMade(const Visit& visit, const PlanRequest& request, PathOutcome last) const {
  const auto isThere = [&](const Eigen::Vector3d& position) {
    return (position - visit.place).norm() < kThere_m;
  };
  const auto cameBy = [&](const StampedPose& stamped) {
    return stamped.time_s > visit.chosen_s && isThere(stamped.pose.position);
  };
  if (last == PathOutcome::kReached && isThere(request.pose.position)) return true;
  return std::any_of(request.trail.begin(), request.trail.end(), cameBy) ||
         std::any_of(starts_.begin(), starts_.end(), [&](const StampedPose& start) {
           return start.time_s <= request.time_s - kLook_s && cameBy(start);
         });
}

std::vector<Visit> Visits::takeMade(const PlanRequest& request, PathOutcome last) {
  noteStart(request, last);
  std::vector<Visit> made;
  std::vector<Visit> open;
  for (const Visit& visit : expected_)
    (isMade(visit, request, last) ? made : open).push_back(visit);
  expected_ = std::move(open);
  return made;
}

}  // namespace spelunk::planners
