#include "search_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spelunk::navigation {
namespace {

constexpr double kPiece_m = 1.6;   // of sweeps: small windows, made quickly
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

InflatedGrids::InflatedGrids(std::shared_ptr<const map::FrozenMap> map, const Eigen::Vector3d& box,
                             double safe_distance_m)
    : map_(std::move(map)),
      box_(box),
      safe_box_(box + Eigen::Vector3d::Constant(2.0 * safe_distance_m)) {}

SegmentChecker& InflatedGrids::made(std::optional<SegmentChecker>& checker,
                                    const Eigen::Vector3d& box, map::Passable passable) {
  if (!checker) checker.emplace(map_, box, SweepTiles{passable, kPiece_m});
  return *checker;
}

SearchSpace::SearchSpace(const NavigationQuery& query, const Eigen::Vector3d& start,
                         InflatedGrids& grids, Unknown unknown, Clearance clearance)
    : query_(query), start_(start), grids_(grids), unknown_(unknown), clearance_(clearance) {}

bool SearchSpace::isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (!isAllowed(a, b)) return false;
  SegmentChecker& box = unknown_ == Unknown::kClosed ? grids_.known() : grids_.open();
  return box.isFree(a, b) && (clearance_ == Clearance::kBox || keepsSafeDistance(a, b));
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
  return grids_.safe().isFree(a + from * (b - a), a + to * (b - a));
}

double knownLength(const Path& path, SegmentChecker& known, double step_m) {
  double arc = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector3d& a = path[i - 1].position;
    const Eigen::Vector3d way = path[i].position - a;
    if (known.isFree(a, path[i].position)) {
      arc += way.norm();
      continue;
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / step_m)));
    int free = 0;
    while (free < steps && known.isFree(a + way * (static_cast<double>(free) / steps),
                                        a + way * (static_cast<double>(free + 1) / steps)))
      ++free;
    return arc + way.norm() * free / steps;
  }
  return arc;
}

std::optional<Eigen::Vector3d> freePlaceNear(const Eigen::Vector3d& place, SearchSpace& space,
                                             InflatedGrids& grids) {
  static const std::vector<Eigen::Vector3d> kOffsets = offsetsByDistance();
  for (const Eigen::Vector3d& offset : kOffsets) {
    const Eigen::Vector3d candidate = place + offset;
    if (space.isFree(candidate) && grids.body().isFree(place, candidate)) return candidate;
  }
  return std::nullopt;
}

}  // namespace spelunk::navigation
