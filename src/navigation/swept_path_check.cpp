#include "spelunk/navigation/swept_path_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "spelunk/common/contract.h"

namespace spelunk::navigation {
namespace {

constexpr double kPieceMax_m = 8.0;  // a diagonal window of this size is still small
constexpr double kTile_m = 6.4;      // segments up to this length are answered from a tile

AxisAlignedBox around(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& margin) {
  return {a.cwiseMin(b) - margin, a.cwiseMax(b) + margin};
}

Eigen::Vector3d windowMargin(const Eigen::Vector3d& box, double resolution_m) {
  return 0.5 * box + Eigen::Vector3d::Constant(2.0 * resolution_m);
}

struct SegmentFault {
  PathFault fault = PathFault::kNone;
  double along_m = 0.0;
};

PathFault faultOf(map::Occupancy occupancy) {
  if (occupancy == map::Occupancy::kFree) return PathFault::kNone;
  return occupancy == map::Occupancy::kOccupied ? PathFault::kOccupied : PathFault::kUnknown;
}

/// How far the box gets on a segment whose whole sweep is not free.
double freeLength(const map::InflatedWindow& window, const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b, double step_m) {
  const double length = (b - a).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / step_m)));
  Eigen::Vector3d last = a;
  if (!window.isFree(a)) return 0.0;
  for (int k = 1; k <= steps; ++k) {
    const Eigen::Vector3d next = a + (b - a) * (static_cast<double>(k) / steps);
    if (!window.isSweepFree(last, next)) return length * (k - 1) / steps;
    last = next;
  }
  return 0.0;
}

SegmentFault checkPiece(const map::FrozenMap& map, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& box) {
  const double resolution = map.resolution();
  const map::LocalWindow local(map, around(a, b, windowMargin(box, resolution)));
  const map::InflatedWindow window(local, box);
  const PathFault fault = faultOf(window.sweep(a, b));
  if (fault == PathFault::kNone) return {};
  return {fault, freeLength(window, a, b, resolution)};
}

SegmentFault checkOccupancy(const map::FrozenMap& map, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, const Eigen::Vector3d& box) {
  const double length = (b - a).norm();
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / kPieceMax_m)));
  for (int k = 0; k < pieces; ++k) {
    const double from = static_cast<double>(k) / pieces;
    const double to = static_cast<double>(k + 1) / pieces;
    SegmentFault found = checkPiece(map, a + from * (b - a), a + to * (b - a), box);
    if (found.fault == PathFault::kNone) continue;
    found.along_m += from * length;
    return found;
  }
  return {};
}

const NoGoZone* findZone(const std::vector<NoGoZone>& zones, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b, const Eigen::Vector3d& box) {
  const auto met = std::find_if(zones.begin(), zones.end(), [&](const NoGoZone& zone) {
    return sweptBoxMeets(zone, a, b, box);
  });
  return met == zones.end() ? nullptr : &*met;
}

/// The fault of one segment with `arc_m` counted from its begin.
PathCheck checkSegment(const map::FrozenMap& map, const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b, const Eigen::Vector3d& box,
                       const std::vector<NoGoZone>& zones, const AxisAlignedBox& bounds) {
  if (!bounds.contains(a) || !bounds.contains(b)) return {PathFault::kOutOfBounds, 0.0, ""};
  if (const NoGoZone* zone = findZone(zones, a, b, box)) return {PathFault::kNoGo, 0.0, zone->name};
  const SegmentFault occupancy = checkOccupancy(map, a, b, box);
  return {occupancy.fault, occupancy.along_m, ""};
}

}  // namespace

const char* toText(PathFault fault) {
  switch (fault) {
    case PathFault::kNone:
      return "free";
    case PathFault::kOccupied:
      return "occupied";
    case PathFault::kUnknown:
      return "unknown";
    case PathFault::kOutOfBounds:
      return "out of bounds";
    case PathFault::kNoGo:
      return "no-go zone";
  }
  return "unknown";
}

PathCheck checkPath(const map::FrozenMap& map, const Path& path, const Eigen::Vector3d& box,
                    const std::vector<NoGoZone>& zones, const AxisAlignedBox& bounds) {
  require(!path.empty(), "checkPath: empty path");
  double arc = 0.0;
  for (std::size_t i = path.size() == 1 ? 0 : 1; i < path.size(); ++i) {
    const Eigen::Vector3d& a = path[i == 0 ? 0 : i - 1].position;
    const Eigen::Vector3d& b = path[i].position;
    PathCheck found = checkSegment(map, a, b, box, zones, bounds);
    if (!found.isFree()) {
      found.arc_m += arc;
      return found;
    }
    arc += (b - a).norm();
  }
  return {PathFault::kNone, arc, ""};
}

struct SegmentChecker::Impl {
  std::shared_ptr<const map::FrozenMap> map;
  Eigen::Vector3d box;
  SweepTiles how;
  std::map<std::tuple<int, int, int>, map::InflatedWindow> tiles;

  const map::InflatedWindow& tileAt(const Eigen::Vector3d& point) {
    const Eigen::Vector3i index = (point / kTile_m).array().floor().cast<int>();
    const auto key = std::make_tuple(index.x(), index.y(), index.z());
    const auto found = tiles.find(key);
    if (found != tiles.end()) return found->second;
    const Eigen::Vector3d low = kTile_m * index.cast<double>();
    const Eigen::Vector3d margin =
        windowMargin(box, map->resolution()) + Eigen::Vector3d::Constant(0.5 * how.piece_m);
    const map::LocalWindow local(*map,
                                 around(low, low + Eigen::Vector3d::Constant(kTile_m), margin));
    return tiles.emplace(key, map::InflatedWindow(local, box, how.passable)).first->second;
  }
};

SegmentChecker::SegmentChecker(std::shared_ptr<const map::FrozenMap> map,
                               const Eigen::Vector3d& box, const SweepTiles& tiles)
    : impl_(new Impl{std::move(map), box, tiles, {}}) {
  require(impl_->map != nullptr, "SegmentChecker: no map");
  require(tiles.piece_m > 0.0, "SegmentChecker: pieces without length");
}
SegmentChecker::~SegmentChecker() = default;
SegmentChecker::SegmentChecker(SegmentChecker&&) noexcept = default;

map::Occupancy SegmentChecker::sweep(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d way = b - a;
  const int pieces = std::max(1, static_cast<int>(std::ceil(way.norm() / impl_->how.piece_m)));
  Eigen::Vector3d from = a;
  for (int k = 1; k <= pieces; ++k) {
    const Eigen::Vector3d to = k == pieces ? b : a + way * (static_cast<double>(k) / pieces);
    const map::Occupancy found = impl_->tileAt(0.5 * (from + to)).sweep(from, to);
    if (found != map::Occupancy::kFree) return found;
    from = to;
  }
  return map::Occupancy::kFree;
}

bool SegmentChecker::isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return sweep(a, b) == map::Occupancy::kFree;
}

map::Occupancy SegmentChecker::boxAt(const Eigen::Vector3d& centre) {
  return impl_->tileAt(centre).boxAt(centre);
}

std::size_t SegmentChecker::windows() const { return impl_->tiles.size(); }

}  // namespace spelunk::navigation
