#pragma once

#include "spelunk/common/robot_model.h"
#include "spelunk/graph/path_similarity.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/shared/free_space.h"

namespace spelunk::planners {

/// The known free space of one request, everywhere in the map: where the robot's box may be, and
/// ways through it by navigation. Refers to all it is made of, which must outlive it.
class KnownSpace {
 public:
  /// `boxes`: kept from plan to plan, for the robot's box; it is told the request's map.
  KnownSpace(const PlanRequest& request, const RobotModel& robot, navigation::Navigator& navigator,
             map::ConfigurationSpace& boxes);
  KnownSpace(const KnownSpace&) = delete;  // its free space refers to its checker
  KnownSpace& operator=(const KnownSpace&) = delete;

  [[nodiscard]] const FreeSpace& free() const { return free_; }
  [[nodiscard]] bool isFree(const graph::Polyline& line) const;
  /// Whether the box at a place keeps navigation's safe distance.
  [[nodiscard]] bool isRoomy(const Eigen::Vector3d& place) const {
    return navigator_.keepsSafeDistance(request_.map, robot_.box_m, place);
  }
  /// Waypoints left out where a straight way of at most `reach_m` leads past them.
  [[nodiscard]] graph::Polyline shortened(const graph::Polyline& line, double reach_m) const;

  /// The motion planner; `stream` names this query's random draws.
  [[nodiscard]] navigation::NavigationAnswer navigate(const Eigen::Vector3d& from,
                                                      const Eigen::Vector3d& to,
                                                      const std::string& stream,
                                                      navigation::TreeDetail trees);

 private:
  const PlanRequest& request_;
  const RobotModel& robot_;
  navigation::Navigator& navigator_;
  map::ConfigurationSpace& boxes_;
  FreeSpace free_;
};

}  // namespace spelunk::planners
