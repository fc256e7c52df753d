#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "spelunk/common/pose.h"
#include "spelunk/common/rng.h"
#include "spelunk/common/scan.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/terrain/terrain_map.h"
#include "support/meshes.h"

namespace spelunk::terrain {

constexpr double kBaseHeight_m = 0.5;

/// 16 rows, 0.7 m above the ground.
inline SensorModel walkerLidar() {
  SensorModel sensor;
  sensor.mount_m = {0.0, 0.0, 0.2};
  return sensor;
}

/// At the front of the body, looking down.
inline SensorModel frontCamera() {
  SensorModel sensor;
  sensor.name = "front_camera";
  sensor.kind = "depth_camera";
  sensor.fov_horizontal_deg = 86;
  sensor.fov_vertical_deg = 57;
  sensor.rows = 240;
  sensor.columns = 320;
  sensor.range_min_m = 0.2;
  sensor.range_max_m = 8.0;
  sensor.mount_m = {0.5, 0.0, 0.1};
  sensor.mount_pitch_deg = 30.0;
  return sensor;
}

/// The base of a robot that stands upright at x, y on ground of height z.
inline Eigen::Isometry3d baseAt(double x, double y, double yaw = 0.0, double ground_z = 0.0) {
  return T_world_base({{x, y, ground_z + kBaseHeight_m}, yaw});
}

/// What a sensor sees in a mesh, with noise along the rays; misses are left out.
inline Scan scanOf(const sim::MeshScene& scene, const SensorModel& sensor,
                   const Eigen::Isometry3d& T_world_base, double stamp_s, double noise_m = 0.0,
                   std::uint64_t seed = 1) {
  Scan scan;
  scan.stamp_s = stamp_s;
  scan.sensor = sensor.name;
  scan.T_world_sensor = T_world_base * T_base_sensor(sensor);
  const std::vector<Eigen::Vector3f> directions = rayDirections(sensor);
  std::vector<Eigen::Vector3f> rays;
  for (const Eigen::Vector3f& direction : directions)
    rays.emplace_back(scan.T_world_sensor.linear().cast<float>() * direction);
  std::vector<float> ranges;
  const auto range_max = static_cast<float>(sensor.range_max_m);
  scene.castFan(scan.T_world_sensor.translation().cast<float>(), rays, range_max, ranges);
  Rng rng(seed);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (ranges[i] < range_max)
      scan.points.emplace_back(directions[i] *
                               (ranges[i] + static_cast<float>(noise_m * rng.normal())));
  return scan;
}

/// A slab of ground whose top is at `z`.
inline void addSlab(sim::WorldMesh& mesh, double x0, double x1, double y0, double y1, double z) {
  test::addBox(mesh, Eigen::Vector3d(x0, y0, z - 3.0).cast<float>(),
               Eigen::Vector3d(x1, y1, z).cast<float>());
}

/// Flat ground with a square pit of `side_m` whose near edge is at x = `at_m`.
inline sim::WorldMesh groundWithHole(double at_m, double side_m, double depth_m) {
  const double far = at_m + side_m;
  const double half = 0.5 * side_m;
  sim::WorldMesh mesh;
  addSlab(mesh, -10.0, at_m, -10.0, 10.0, 0.0);
  addSlab(mesh, far, 20.0, -10.0, 10.0, 0.0);
  addSlab(mesh, at_m, far, -10.0, -half, 0.0);
  addSlab(mesh, at_m, far, half, 10.0, 0.0);
  addSlab(mesh, at_m, far, -half, half, -depth_m);
  return mesh;
}

/// Ground of two levels: 0, and `rise_m` from x = `at_m` on.
inline sim::WorldMesh groundWithStep(double at_m, double rise_m) {
  sim::WorldMesh mesh;
  addSlab(mesh, -10.0, at_m, -10.0, 10.0, 0.0);
  addSlab(mesh, at_m, 20.0, -10.0, 10.0, rise_m);
  return mesh;
}

/// Flat until x = `at_m`, then rising at `angle_rad` for `length_m`, then flat again.
inline sim::WorldMesh groundWithRamp(double at_m, double angle_rad, double length_m) {
  const double rise = std::tan(angle_rad) * length_m;
  sim::WorldMesh mesh;
  addSlab(mesh, -10.0, at_m, -10.0, 10.0, 0.0);
  addSlab(mesh, at_m + length_m, 20.0, -10.0, 10.0, rise);
  const int base = static_cast<int>(mesh.vertices.size());
  for (const double x : {at_m, at_m + length_m})
    for (const double y : {-10.0, 10.0})
      mesh.vertices.push_back(Eigen::Vector3d(x, y, x > at_m ? rise : 0.0).cast<float>());
  mesh.triangles.emplace_back(base, base + 1, base + 2);
  mesh.triangles.emplace_back(base + 1, base + 3, base + 2);
  return mesh;
}

/// Which sensors a walk uses.
enum class Sight { kLidarOnly, kLidarAndCamera };

/// Walks along x from `from_m` to `to_m` at 0.5 m/s with scans at 10 Hz, every second one with the
/// camera too; the ground under the robot is at `ground(x)`.
template <class Ground>
void walk(TerrainMap& terrain, const sim::MeshScene& scene, double from_m, double to_m, Sight sight,
          Ground&& ground, double noise_m = 0.005) {
  std::uint64_t scans = 0;
  for (double x = from_m; x <= to_m + 1e-9; x += 0.05, ++scans) {
    const Eigen::Isometry3d base = baseAt(x, 0.0, 0.0, ground(x));
    const double stamp = 0.1 * static_cast<double>(scans);
    terrain.insert(scanOf(scene, walkerLidar(), base, stamp, noise_m, 2 * scans), base);
    if (sight == Sight::kLidarAndCamera && scans % 2 == 0)
      terrain.insert(scanOf(scene, frontCamera(), base, stamp, noise_m, 2 * scans + 1), base);
  }
}
inline void walk(TerrainMap& terrain, const sim::MeshScene& scene, double from_m, double to_m,
                 Sight sight) {
  walk(terrain, scene, from_m, to_m, sight, [](double) { return 0.0; });
}

/// The class of the cell at x, y as a letter, for messages.
inline char letterOf(GroundClass ground) { return "?.SHRD"[static_cast<int>(ground)]; }

/// Rows of classes from x0 to x1 and y0 to y1, every `step_m`; y grows upwards in the text.
inline std::string pictureOf(const TerrainView& view, double x0, double x1, double y0, double y1,
                             double step_m) {
  std::string text;
  for (double y = y1; y >= y0; y -= step_m) {
    for (double x = x0; x <= x1; x += step_m)
      text += letterOf(view.classAt(view.grid().cellOf({x, y})));
    text += '\n';
  }
  return text;
}

}  // namespace spelunk::terrain
