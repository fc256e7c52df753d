#pragma once

#include <memory>
#include <optional>

#include "spelunk/navigation/navigator.h"
#include "spelunk/navigation/swept_path_check.h"

namespace spelunk::navigation {

/// The inflated grids of one map and box, each made when it is first asked.
class InflatedGrids {
 public:
  InflatedGrids(std::shared_ptr<const map::FrozenMap> map, const Eigen::Vector3d& box,
                double safe_distance_m);

  [[nodiscard]] bool isFor(const NavigationQuery& query) const {
    return query.map == map_ && query.box == box_;
  }
  SegmentChecker& known() { return made(known_, box_, map::Passable::kKnownFree); }
  SegmentChecker& open() { return made(open_, box_, map::Passable::kNotOccupied); }
  /// The box grown by the safe distance on each side, kept clear of obstacles only.
  SegmentChecker& safe() { return made(safe_, safe_box_, map::Passable::kNotOccupied); }
  /// Half the box, kept clear of obstacles only: the robot's body.
  SegmentChecker& body() { return made(body_, 0.5 * box_, map::Passable::kNotOccupied); }

 private:
  SegmentChecker& made(std::optional<SegmentChecker>& checker, const Eigen::Vector3d& box,
                       map::Passable passable);

  std::shared_ptr<const map::FrozenMap> map_;
  Eigen::Vector3d box_;
  Eigen::Vector3d safe_box_;
  std::optional<SegmentChecker> known_;
  std::optional<SegmentChecker> open_;
  std::optional<SegmentChecker> safe_;
  std::optional<SegmentChecker> body_;
};

enum class Unknown { kClosed, kOpen };
enum class Clearance { kBox, kSafeDistance };

/// Where one search may go. A view for the duration of one query.
class SearchSpace {
 public:
  SearchSpace(const NavigationQuery& query, const Eigen::Vector3d& start, InflatedGrids& grids,
              Unknown unknown, Clearance clearance);

  [[nodiscard]] bool isFree(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  [[nodiscard]] bool isFree(const Eigen::Vector3d& point) { return isFree(point, point); }

  [[nodiscard]] Unknown unknown() const { return unknown_; }
  [[nodiscard]] Clearance clearance() const { return clearance_; }

 private:
  [[nodiscard]] bool isAllowed(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
  [[nodiscard]] bool keepsSafeDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

  const NavigationQuery& query_;
  Eigen::Vector3d start_;
  InflatedGrids& grids_;
  Unknown unknown_;
  Clearance clearance_;
};

/// The line's length up to which the box is in known free space, to about a voxel.
[[nodiscard]] double knownLength(const Path& path, SegmentChecker& known, double step_m);

/// The given place if the box is free there; else the nearest one within 0.6 m that the robot's
/// body can step out to.
[[nodiscard]] std::optional<Eigen::Vector3d> freePlaceNear(const Eigen::Vector3d& place,
                                                           SearchSpace& space,
                                                           InflatedGrids& grids);

}  // namespace spelunk::navigation
