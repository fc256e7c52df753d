#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bench.h"
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

using Key = std::pair<int, int>;

/// The filter of terrain::ElevationMap cell by cell in a std::map, in doubles.
class PlainElevation {
 public:
  struct Cell {
    double height = 0.0;
    double variance = 0.0;
    double other = -1e9;
    int others = 0;
  };

  explicit PlainElevation(const terrain::ElevationParams& params) : params_(params) {}

  void insert(const Scan& scan, const Eigen::Isometry3d& T_world_base) {
    const Eigen::Vector3d base = T_world_base.translation();
    const double way = last_ ? (base - *last_).norm() : 0.0;
    const double seconds = last_ ? scan.stamp_s - last_stamp_s_ : 0.0;
    if (way > 1e-4)
      for (auto& [key, cell] : cells_)
        cell.variance += params_.growth_m2_per_m * way + params_.growth_m2_per_s * seconds;
    last_ = base;
    last_stamp_s_ = scan.stamp_s;
    std::map<Key, std::vector<double>> returns;
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d at = scan.T_world_sensor * point.cast<double>();
      if (isKept(at, T_world_base)) returns[keyOf(at)].push_back(at.z());
    }
    const double high = base.z() - params_.base_height_m + params_.clearance_m;
    std::vector<const std::pair<const Key, std::vector<double>>*> high_ones;
    for (const auto& entry : returns) {
      if (*std::min_element(entry.second.begin(), entry.second.end()) > high)
        high_ones.push_back(&entry);
      else
        enter(entry.first, entry.second, scan.T_world_sensor.translation());
    }
    std::vector<bool> hang;
    for (const auto* entry : high_ones)
      hang.push_back(
          hangs(entry->first, *std::min_element(entry->second.begin(), entry->second.end()), base));
    for (std::size_t i = 0; i < high_ones.size(); ++i)
      if (!hang[i])
        enter(high_ones[i]->first, high_ones[i]->second, scan.T_world_sensor.translation());
  }

  [[nodiscard]] const std::map<Key, Cell>& cells() const { return cells_; }

  /// The plane through every cell's window by sums over it: tangents of the slopes.
  [[nodiscard]] std::map<Key, double> slopes(const terrain::TraversabilityParams& params) const {
    std::map<Key, double> slopes;
    const int plane = static_cast<int>(std::lround(params.slope_window_m / params_.cell_m));
    for (const auto& [key, cell] : cells_) {
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      for (int y = -plane; y <= plane; ++y)
        for (int x = -plane; x <= plane; ++x) {
          const auto found = cells_.find({key.first + x, key.second + y});
          if (found == cells_.end()) continue;
          const Eigen::Vector3d row(x * params_.cell_m, y * params_.cell_m, 1.0);
          A += row * row.transpose();
          b += row * (found->second.height - cell.height);
        }
      slopes[key] = A.ldlt().solve(b).head<2>().norm();
    }
    return slopes;
  }

 private:
  [[nodiscard]] Key keyOf(const Eigen::Vector3d& point) const {
    return {static_cast<int>(std::floor(point.x() / params_.cell_m)),
            static_cast<int>(std::floor(point.y() / params_.cell_m))};
  }
  [[nodiscard]] bool isKept(const Eigen::Vector3d& at, const Eigen::Isometry3d& T) const {
    const Eigen::Vector3d base = T.translation();
    const Key key = keyOf(at);
    const Key middle = keyOf(base);
    const int reach = static_cast<int>(std::ceil(params_.reach_m / params_.cell_m - 1e-9));
    if (std::abs(key.first - middle.first) > reach || std::abs(key.second - middle.second) > reach)
      return false;
    const Eigen::Vector3d in_base = T.inverse() * at;
    if ((in_base.array().abs() <= 0.5 * params_.body_m.array()).all()) return false;
    return at.z() <= base.z() - params_.base_height_m + params_.clearance_m +
                         climb() * (at - base).head<2>().norm();
  }
  [[nodiscard]] double climb() const { return std::tan(params_.climb_deg * M_PI / 180.0); }
  [[nodiscard]] bool hangs(const Key& key, double lowest, const Eigen::Vector3d& base) const {
    if (cells_.count(key) > 0) return false;
    const Key middle = keyOf(base);
    const Eigen::Vector2d way(middle.first - key.first, middle.second - key.second);
    const double foot = base.z() - params_.base_height_m;
    const double rise = climb() * params_.cell_m;
    for (int at = 2; at < way.norm(); at += 2) {
      const Eigen::Vector2d step = way * (at / way.norm());
      const auto found = cells_.find({key.first + static_cast<int>(std::lround(step.x())),
                                      key.second + static_cast<int>(std::lround(step.y()))});
      if (found == cells_.end()) continue;
      if (found->second.height < foot - rise * (way.norm() - at) - 0.3) continue;
      if (lowest > found->second.height + params_.clearance_m + rise * at) return true;
    }
    return false;
  }
  void enter(const Key& key, const std::vector<double>& heights, const Eigen::Vector3d& sensor) {
    const double lowest = *std::min_element(heights.begin(), heights.end());
    const auto found = cells_.find(key);
    if (found != cells_.end() && lowest > found->second.height + params_.clearance_m) return;
    double top = lowest;
    for (const double z : heights)
      if (z <= lowest + params_.clearance_m) top = std::max(top, z);
    double sum = 0.0;
    int count = 0;
    for (const double z : heights)
      if (z <= top && z >= top - 0.1) sum += z, ++count;
    const double measured = sum / count;
    const Eigen::Vector3d centre((key.first + 0.5) * params_.cell_m,
                                 (key.second + 0.5) * params_.cell_m, measured);
    const double deviation =
        params_.noise_base_m + params_.noise_quadratic_1pm * (centre - sensor).squaredNorm();
    const double noise =
        deviation * deviation / std::min(count, 4) + params_.cell_m * params_.cell_m / 16.0;
    if (found == cells_.end())
      cells_[key] = {measured, noise};
    else
      fuse(measured, noise, found->second);
  }
  void fuse(double measured, double noise, Cell& cell) const {
    const double gate = params_.gate_sigmas * params_.gate_sigmas;
    const double innovation = measured - cell.height;
    const double spread = cell.variance + noise;
    if (innovation * innovation <= gate * spread) {
      cell.height += cell.variance / spread * innovation;
      cell.variance = std::max(9e-6, cell.variance * (1.0 - cell.variance / spread));
      if (cell.other >= cell.height - params_.clearance_m) cell.others = 0;
      return;
    }
    const double apart = measured - cell.other;
    cell.others = cell.others > 0 && apart * apart <= 2.0 * gate * noise ? cell.others + 1 : 1;
    cell.other = measured;
    if (cell.others >= params_.conflicts_to_replace) cell = {measured, noise};
  }

  terrain::ElevationParams params_;
  std::map<Key, Cell> cells_;
  std::optional<Eigen::Vector3d> last_;
  double last_stamp_s_ = 0.0;
};

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
int slopesDifferPer10000(const terrain::TerrainMap& ours, const std::map<Key, double>& plain) {
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
    std::map<Key, double> slopes;
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
