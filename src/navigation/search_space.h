#pragma once

#include <memory>
#include <optional>

#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/navigator.h"

namespace spelunk::navigation {

/// Where the robot's box may be, by what it may touch.
class InflatedGrids {
 public:
  InflatedGrids(const Eigen::Vector3d& box, double safe_distance_m);

  [[nodiscard]] const Eigen::Vector3d& box() const { return known_.boxSize(); }
  /// From now on everything is about this map; what did not change in it is kept.
  void use(const std::shared_ptr<const map::FrozenMap>& map);

  map::ConfigurationSpace& known() { return known_; }
  map::ConfigurationSpace& open() { return open_; }
  /// The box grown by the safe distance on each side, kept clear of obstacles only.
  map::ConfigurationSpace& safe() { return safe_; }
  /// Half the box, kept clear of obstacles only: the robot's body.
  map::ConfigurationSpace& body() { return body_; }

 private:
  map::ConfigurationSpace known_;
  map::ConfigurationSpace open_;
  map::ConfigurationSpace safe_;
  map::ConfigurationSpace body_;
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
[[nodiscard]] double knownLength(const Path& path, map::ConfigurationSpace& known);

/// The given place if the box is free there; else the nearest one within 0.6 m that the robot's
/// body can step out to.
[[nodiscard]] std::optional<Eigen::Vector3d> freePlaceNear(const Eigen::Vector3d& place,
                                                           SearchSpace& space,
                                                           InflatedGrids& grids);

}  // namespace spelunk::navigation
