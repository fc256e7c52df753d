#include "spelunk/planners/shared/visits.h"

#include <algorithm>

namespace spelunk::planners {
namespace {

constexpr double kThere_m = 0.75;  // poses of the trail are about a metre apart
constexpr std::size_t kExpectedMax = 6;

bool isMade(const Visit& visit, const PlanRequest& request, PathOutcome last) {
  const auto isThere = [&](const Eigen::Vector3d& position) {
    return (position - visit.place).norm() < kThere_m;
  };
  if (last == PathOutcome::kReached && isThere(request.pose.position)) return true;
  return std::any_of(request.trail.begin(), request.trail.end(), [&](const StampedPose& stamped) {
    return stamped.time_s > visit.chosen_s && isThere(stamped.pose.position);
  });
}

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

std::vector<Visit> Visits::takeMade(const PlanRequest& request, PathOutcome last) {
  std::vector<Visit> made;
  std::vector<Visit> open;
  for (const Visit& visit : expected_)
    (isMade(visit, request, last) ? made : open).push_back(visit);
  expected_ = std::move(open);
  return made;
}

}  // namespace spelunk::planners
