#include <algorithm>
#include <cmath>
#include <map>

#include "bench.h"
#include "plain_elevation.h"
#include "spelunk/terrain/terrain_map.h"

namespace spelunk::benchmark {
namespace {

constexpr double kBaseHeight_m = 0.5;
constexpr int kPoses = 40;

SensorModel depthCamera(double yaw_deg) {
  SensorModel camera;
  camera.kind = "depth_camera";
  camera.fov_horizontal_deg = 86.0;
  camera.fov_vertical_deg = 57.0;
  camera.rows = 240;
  camera.columns = 320;
  camera.range_max_m = 8.0;
  camera.mount_yaw_deg = yaw_deg;
  camera.mount_pitch_deg = 30.0;
  camera.mount_m = {yaw_deg == 0.0 ? 0.5 : -0.5, 0.0, 0.1};
  return camera;
}

struct Glance {
  Eigen::Isometry3d T_world_base;
  std::vector<Scan> scans;  ///< LiDAR, front and rear camera.
};

Scan scanOf(const sim::MeshScene& scene, const SensorModel& sensor,
            const Eigen::Isometry3d& T_world_base, double stamp_s, Rng& noise) {
  Scan scan;
  scan.stamp_s = stamp_s;
  scan.T_world_sensor = T_world_base * T_base_sensor(sensor);
  const std::vector<Eigen::Vector3f> directions = rayDirections(sensor);
  const Eigen::Matrix3f R = scan.T_world_sensor.linear().cast<float>();
  std::vector<Eigen::Vector3f> rays;
  for (const Eigen::Vector3f& direction : directions) rays.emplace_back(R * direction);
  std::vector<float> ranges;
  const auto range_max = static_cast<float>(sensor.range_max_m);
  scene.castFan(scan.T_world_sensor.translation().cast<float>(), rays, range_max, ranges);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (ranges[i] < range_max)
      scan.points.push_back(directions[i] *
                            (ranges[i] + static_cast<float>(0.005 * noise.normal())));
  return scan;
}

/// A robot that walks 5 cm from look to look, upright above the ground below it.
std::vector<Glance> walkOnTheGround(const MineWalk& walk) {
  SensorModel lidar;
  lidar.mount_m = {0.0, 0.0, 0.2};
  Rng noise(7);
  std::vector<Glance> glances;
  const Pose start = *walk.mesh.start;
  for (int i = 0; i < kPoses; ++i) {
    Pose pose = start;
    pose.position += 0.05 * i * Eigen::Vector3d(std::cos(start.yaw), std::sin(start.yaw), 0.0);
    std::vector<float> down;
    walk.scene.castFan(pose.position.cast<float>(), {-Eigen::Vector3f::UnitZ()}, 50.0F, down);
    pose.position.z() += kBaseHeight_m - static_cast<double>(down[0]);
    Glance glance{T_world_base(pose), {}};
    for (const SensorModel& sensor : {lidar, depthCamera(0.0), depthCamera(180.0)})
      glance.scans.push_back(scanOf(walk.scene, sensor, glance.T_world_base, 0.1 * i, noise));
    glances.push_back(std::move(glance));
  }
  return glances;
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Cells that both know and whose heights differ by more than 1 mm, in 10,000. Points on a border
/// of cells may fall on either side.
int differencesPer10000(const terrain::ElevationMap& ours, const PlainElevation& plain) {
  int compared = 0;
  int different = 0;
  for (const auto& [key, cell] : plain.cells()) {
    if (!ours.grid().contains({key.first, key.second})) continue;
    const auto known = ours.at({key.first, key.second});
    ++compared;
    different += !known || std::fabs(known->height_m - cell.height) > 1e-3 ? 1 : 0;
  }
  return different * 10000 / std::max(1, compared);
}

/// Covered cells whose slopes (tangents) differ by more than 0.01, in 10,000.
int slopesDifferPer10000(const terrain::TerrainMap& ours,
                         const std::map<PlainElevation::Key, double>& plain) {
  const terrain::WindowGrid& grid = ours.elevation().grid();
  const terrain::Traversability& traversability = ours.traversability();
  int compared = 0;
  int different = 0;
  for (int y = traversability.margin(); y < grid.side() - traversability.margin(); ++y)
    for (int x = traversability.margin(); x < grid.side() - traversability.margin(); ++x) {
      const terrain::CellIndex cell = grid.first() + terrain::CellIndex(x, y);
      const terrain::TraversabilityLayers& layers = traversability.layers();
      const std::size_t slot = grid.slotOf(cell);
      const auto found = plain.find({cell.x(), cell.y()});
      if (!ours.elevation().at(cell) || found == plain.end()) continue;
      if (layers.ground_class[slot] == terrain::GroundClass::kUnknown) continue;
      ++compared;
      different += std::fabs(layers.slope[slot] - found->second) > 0.01 ? 1 : 0;
    }
  return different * 10000 / std::max(1, compared);
}

}  // namespace

std::vector<Row> terrainRows(const MineWalk& walk) {
  const std::vector<Glance> glances = walkOnTheGround(walk);
  terrain::TerrainMap ours{terrain::TerrainParams{}};
  PlainElevation plain(ours.elevation().params());
  std::vector<double> elevation_ms;
  std::vector<double> plain_elevation_ms;
  std::vector<double> whole_ms;
  std::vector<double> plain_whole_ms;
  int slopes_differ = 0;
  for (std::size_t i = 0; i < glances.size(); ++i) {
    const Glance& glance = glances[i];
    elevation_ms.push_back(1e3 * secondsOf([&] {
                             for (const Scan& scan : glance.scans)
                               ours.insert(scan, glance.T_world_base);
                           }));
    whole_ms.push_back(elevation_ms.back() + 1e3 * secondsOf([&] { (void)ours.freeze(); }));
    plain_elevation_ms.push_back(1e3 * secondsOf([&] {
                                   for (const Scan& scan : glance.scans)
                                     plain.insert(scan, glance.T_world_base);
                                 }));
    if (i % 8 != 0) continue;
    std::map<PlainElevation::Key, double> slopes;
    plain_whole_ms.push_back(
        plain_elevation_ms.back() +
        1e3 * secondsOf([&] { slopes = plain.slopes(ours.params().traversability); }));
    slopes_differ = std::max(slopes_differ, slopesDifferPer10000(ours, slopes));
  }
  const int heights_differ = differencesPer10000(ours.elevation(), plain);
  const std::string of_cells = " of 10000 cells differ";
  const std::string scans = ", 4 cm, LiDAR 16 x 1800 and two depth images 320 x 240";
  return {{"elevation map" + scans, "std::map of cells", "ms", medianOf(plain_elevation_ms),
           medianOf(elevation_ms), 3.0, heights_differ < 50,
           "1 mm; " + std::to_string(heights_differ) + of_cells},
          {"the same and traversability", "the same, each cell by sums", "ms",
           medianOf(plain_whole_ms), medianOf(whole_ms), 20.0, slopes_differ < 50,
           "slopes, 0.01; " + std::to_string(slopes_differ) + of_cells}};
}

}  // namespace spelunk::benchmark
