#pragma once

#include <memory>
#include <vector>

#include "spelunk/common/sensor_model.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::test {

/// What a sensor without noise sees from an upright pose in a mesh.
inline sim::SimulatedScan scanFrom(const sim::MeshScene& scene, const SensorModel& sensor,
                                   const Eigen::Vector3d& position, double yaw = 0.0) {
  sim::SimulatedScan scan;
  scan.T_world_sensor_true = T_world_base({position, yaw}) * T_base_sensor(sensor);
  scan.directions = std::make_shared<const std::vector<Eigen::Vector3f>>(rayDirections(sensor));
  scan.range_max_m = static_cast<float>(sensor.range_max_m);
  std::vector<Eigen::Vector3f> in_world;
  const Eigen::Matrix3f rotation = scan.T_world_sensor_true.linear().cast<float>();
  for (const Eigen::Vector3f& direction : *scan.directions)
    in_world.emplace_back(rotation * direction);
  const Eigen::Vector3f origin = scan.T_world_sensor_true.translation().cast<float>();
  scene.castFan(origin, in_world, scan.range_max_m, scan.true_ranges);
  scan.scan.T_world_sensor = scan.T_world_sensor_true;
  for (std::size_t i = 0; i < in_world.size(); ++i)
    scan.scan.points.emplace_back((*scan.directions)[i] * scan.true_ranges[i]);
  return scan;
}

}  // namespace spelunk::test
