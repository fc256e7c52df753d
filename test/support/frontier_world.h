#pragma once

#include <memory>

#include "spelunk/common/robot_model.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/planners/informed/informed_params.h"
#include "support/grid_world.h"

namespace spelunk::test {

/// Those of the paper, for a range of 4 m.
inline planners::informed::InformedParams seeingFourMetres() {
  planners::informed::InformedParams params;
  params.range_m = 4.0;
  return params;
}

/// A robot that sees all around it to 6 m, in a grid world whose map it makes by scans.
class FrontierWorld {
 public:
  static constexpr double kResolution_m = 0.25;

  explicit FrontierWorld(GridWorld world) : world_(std::move(world)), map_(mapParams()) {
    robot.box_m = {0.8, 0.8, 0.4};
    SensorModel sensor;
    sensor.columns = 180;
    sensor.rows = 60;
    sensor.fov_vertical_deg = 170.0;
    sensor.range_min_m = 0.1;
    sensor.range_max_m = 7.0;  // beyond the map's: a miss frees its ray and hits nothing
    sensor.gain_range_m = 6.0;
    robot.sensor_models = {sensor};
    request.budget.iterations = 3000;
    request.rng = Rng(77);
  }

  /// One scan from there; the request is asked on the new map.
  void lookFrom(const Eigen::Vector3d& place) {
    map_.insert(world_.scan(robot.sensor_models.front(), {place, 0.0}, 0.0),
                boxAround(place, robot.box_m));
    map_.markFree(boxAround(place, robot.box_m));
    request.map = map_.freeze();
    request.pose.position = place;
  }

  RobotModel robot;
  planners::PlanRequest request;

 private:
  static map::MapParams mapParams() {
    map::MapParams params;
    params.resolution_m = kResolution_m;
    params.range_max_m = 6.0;
    params.range_min_m = 0.0;
    return params;
  }

  GridWorld world_;
  map::OccupancyMap map_;
};

}  // namespace spelunk::test
