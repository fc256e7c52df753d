#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace spelunk {

/// One range scan with the pose it was taken from.
struct Scan {
  double stamp_s = 0.0;
  std::string sensor;  ///< Name of its SensorModel; may be empty.
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3f> points;  ///< Returns in the sensor frame, metres; NaN allowed.
};

}  // namespace spelunk
