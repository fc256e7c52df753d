#include "search_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spelunk::navigation {
namespace {

constexpr double kWaived_m = 1.0;  // of start and goal: the safe distance is not asked for
constexpr double kStepOut_m = 0.6;
constexpr int kStepOutCells = 4;

/// How much of the way from `from` to `to` lies within the waived radius of `centre`, where `from`
/// does; 0 if it does not.
double waivedShare(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                   const Eigen::Vector3d& centre) {
  const Eigen::Vector3d offset = from - centre;
  const double inside = kWaived_m * kWaived_m - offset.squaredNorm();
  if (inside < 0.0) return 0.0;
  const Eigen::Vector3d way = to - from;
  const double length2 = way.squaredNorm();
  if (length2 == 0.0) return 1.0;
  const double along = way.dot(offset) / length2;
  return std::min(1.0, -along + std::sqrt(along * along + inside / length2));
}

std::vector<Eigen::Vector3d> offsetsByDistance() {
  std::vector<Eigen::Vector3d> offsets;
  for (int x = -kStepOutCells; x <= kStepOutCells; ++x)
    for (int y = -kStepOutCells; y <= kStepOutCells; ++y)
      for (int z = -kStepOutCells; z <= kStepOutCells; ++z) {
        const Eigen::Vector3d offset = Eigen::Vector3d(x, y, z) * (kStepOut_m / kStepOutCells);
        if (offset.norm() <= kStepOut_m) offsets.push_back(offset);
      }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  return offsets;
}

}  // namespace

SearchSpace::SearchSpace(const NavigationQuery& query, const Eigen::Vector3d& start,
                         RobotSpaces& spaces, Unknown unknown, Clearance clearance)
    : query_(query), start_(start), spaces_(spaces), unknown_(unknown), clearance_(clearance) {}

bool SearchSpace::isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (!isAllowed(a, b)) return false;
  map::ConfigurationSpace& box = unknown_ == Unknown::kClosed ? spaces_.known : spaces_.open;
  return box.isSweepFree(a, b) && (clearance_ == Clearance::kBox || keepsSafeDistance(a, b));
}

bool SearchSpace::isAllowed(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  if (!query_.bounds.contains(a) || !query_.bounds.contains(b)) return false;
  return std::none_of(query_.zones.begin(), query_.zones.end(),
                      [&](const NoGoZone& zone) { return sweptBoxMeets(zone, a, b, query_.box); });
}

bool SearchSpace::keepsSafeDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d& goal = query_.goal.position;
  const double from = std::max(waivedShare(a, b, start_), waivedShare(a, b, goal));
  const double to = 1.0 - std::max(waivedShare(b, a, start_), waivedShare(b, a, goal));
  if (from >= to && (from > 0.0 || to < 1.0)) return true;
  return spaces_.safe.isSweepFree(a + from * (b - a), a + to * (b - a));
}

std::optional<Eigen::Vector3d> freePlaceNear(const Eigen::Vector3d& place, SearchSpace& space,
                                             RobotSpaces& spaces) {
  static const std::vector<Eigen::Vector3d> kOffsets = offsetsByDistance();
  for (const Eigen::Vector3d& offset : kOffsets) {
    const Eigen::Vector3d candidate = place + offset;
    if (space.isFree(candidate) && spaces.body.isSweepFree(place, candidate)) return candidate;
  }
  return std::nullopt;
}

}  // namespace spelunk::navigation
