#pragma once

#include <memory>
#include <optional>

#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/navigator.h"

namespace spelunk::navigation {

/// The configuration spaces of one robot: what they inflated is kept from map to map.
struct RobotSpaces {
  RobotSpaces(const Eigen::Vector3d& box, double safe_distance_m)
      : known(box, map::Passable::kKnownFree),
        open(box, map::Passable::kNotOccupied),
        safe(box + Eigen::Vector3d::Constant(2.0 * safe_distance_m), map::Passable::kNotOccupied),
        body(0.5 * box, map::Passable::kNotOccupied) {}

  void use(const std::shared_ptr<const map::FrozenMap>& map) {
    for (map::ConfigurationSpace* space : {&known, &open, &safe, &body}) space->use(map);
  }

  map::ConfigurationSpace known;
  map::ConfigurationSpace open;  ///< Unknown space included.
  map::ConfigurationSpace safe;  ///< The box grown by the safe distance, clear of obstacles only.
  map::ConfigurationSpace body;  ///< Half the box, clear of obstacles only.
};

enum class Unknown { kClosed, kOpen };
enum class Clearance { kBox, kSafeDistance };

/// Where one search may go. A view for the duration of one query.
class SearchSpace {
 public:
  SearchSpace(const NavigationQuery& query, const Eigen::Vector3d& start, RobotSpaces& spaces,
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
  RobotSpaces& spaces_;
  Unknown unknown_;
  Clearance clearance_;
};

/// The given place if the box is free there; else the nearest one within 0.6 m that the robot's
/// body can step out to.
[[nodiscard]] std::optional<Eigen::Vector3d> freePlaceNear(const Eigen::Vector3d& place,
                                                           SearchSpace& space, RobotSpaces& spaces);

}  // namespace spelunk::navigation
