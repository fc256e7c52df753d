#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/path.h"
#include "spelunk/map/frozen_map.h"
#include "spelunk/map/inflated_window.h"

namespace spelunk::navigation {

/// Why a path may not be flown.
enum class PathFault { kNone, kOccupied, kUnknown, kOutOfBounds, kNoGo };

[[nodiscard]] const char* toText(PathFault fault);  ///< "free", "occupied", "unknown", ...

/// The first fault along a path.
struct PathCheck {
  PathFault fault = PathFault::kNone;
  double arc_m =
      0.0;           ///< Arc length up to which the path is known to be good; its length if all is.
  std::string zone;  ///< Name of the no-go zone for kNoGo.

  [[nodiscard]] bool isFree() const { return fault == PathFault::kNone; }
};

/// Checks the box (axis-aligned, full extents, metres, centred on the path) moved along the whole
/// path: every voxel it touches must be known free, every position inside `bounds`, and the box
/// outside all zones. A segment up to 8 m long is one InflatedWindow::sweep from end to end, so the
/// answer equals what a planner gets that sweeps the same segment. A path of one pose is checked
/// there; an empty one breaks the contract.
[[nodiscard]] PathCheck checkPath(const map::FrozenMap& map, const Path& path,
                                  const Eigen::Vector3d& box, const std::vector<NoGoZone>& zones,
                                  const AxisAlignedBox& bounds);

/// How a SegmentChecker answers.
struct SweepTiles {
  map::Passable passable = map::Passable::kKnownFree;
  double piece_m = 6.4;  ///< Longer sweeps are cut into pieces; short ones make smaller windows.
};

/// Answers many box sweeps over a large map: inflated windows are made where a query falls and kept
/// (tiles of 6.4 m), so a query costs a look-up and a walk. With the default tiles the same answers
/// as checkPath() without bounds and zones. Holds the map alive. Not thread-safe.
class SegmentChecker {
 public:
  SegmentChecker(std::shared_ptr<const map::FrozenMap> map, const Eigen::Vector3d& box,
                 const SweepTiles& tiles = {});
  ~SegmentChecker();
  SegmentChecker(SegmentChecker&&) noexcept;

  /// kFree, or why the box moved straight from `a` to `b` may not pass.
  [[nodiscard]] map::Occupancy sweep(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  [[nodiscard]] bool isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  /// The box standing at one point.
  [[nodiscard]] map::Occupancy boxAt(const Eigen::Vector3d& centre);

  /// How many windows were made so far.
  [[nodiscard]] std::size_t windows() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::navigation
