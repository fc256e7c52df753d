#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/ros/convert.h"

namespace spelunk::bridge {

/// What happens to a cloud before it enters the map (section "cloud"). The filters are PCL's and
/// off by default: the map itself forgives single wrong returns.
struct CloudParams {
  double tf_wait_s = 0.5;
  double age_max_s = 5.0;
  double future_max_s = 0.5;
  std::string outlier_filter = "none";
  int outlier_neighbours = 8;
  double outlier_stddevs = 2.0;
  double outlier_radius_m = 0.5;
  double voxel_size_m = 0.0;
  std::string registered_sensor;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("tf_wait_s", tf_wait_s, Bounds{0.0, 10.0}, "a cloud waits this long for its transform");
    field("age_max_s", age_max_s, Bounds{0.1, 1000.0}, "older clouds are refused");
    field("future_max_s", future_max_s, Bounds{0.0, 100.0}, "clouds stamped later are refused");
    field("outlier_filter", outlier_filter, Bounds{}, "against dust: none, statistical or radius");
    field("outlier_neighbours", outlier_neighbours, Bounds{1, 1000},
          "neighbours looked at (statistical) or wanted (radius)");
    field("outlier_stddevs", outlier_stddevs, Bounds{0.0, 20.0},
          "statistical: farther than the mean by so many deviations goes");
    field("outlier_radius_m", outlier_radius_m, Bounds{0.01, 10.0},
          "radius: where neighbours are looked for");
    field("voxel_size_m", voxel_size_m, Bounds{0.0, 5.0},
          "one point a voxel for dense sensors; 0: off");
    field("registered_sensor", registered_sensor, Bounds{},
          "which of robot.sensors took clouds that come in a fixed frame; empty: the only LiDAR");
  }
  [[nodiscard]] std::vector<std::string> problems() const;
};

/// The points of a cloud, brought into the sensor's frame in double precision, those that are not
/// finite left out. Fields x, y, z may be float32 or float64 at any offset, in either order of
/// bytes. Steps that do not fit the data are taken from its size where that allows one answer only.
/// Refused: missing fields, other types, a layout that does not fit the data, no points at all;
/// `problem` continues "a cloud ..." and ends with the remedy.
[[nodiscard]] FromMsg<std::vector<Eigen::Vector3f>> pointsFromMsg(
    const sensor_msgs::PointCloud2& cloud,
    const Eigen::Isometry3d& T_sensor_cloud = Eigen::Isometry3d::Identity());

/// How far the points of a cloud may lie from where they were meant to, metres: half of the
/// distance between neighbouring 32-bit numbers at coordinates of `at_m`; 0 for 64-bit ones.
[[nodiscard]] double coordinateError(const sensor_msgs::PointCloud2& cloud, double at_m);

/// `points` after the filters that `params` switches on: outliers first, then the voxel grid.
[[nodiscard]] std::vector<Eigen::Vector3f> filtered(std::vector<Eigen::Vector3f> points,
                                                    const CloudParams& params);

}  // namespace spelunk::bridge
