#include "bench.h"

#include <time.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::benchmark {
namespace {

Scan scanFrom(const sim::MeshScene& scene, const SensorModel& lidar,
              const std::vector<Eigen::Vector3f>& directions, const Eigen::Vector3d& position,
              double yaw) {
  Scan scan;
  scan.T_world_sensor.translate(position);
  scan.T_world_sensor.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  std::vector<Eigen::Vector3f> rays;
  for (const Eigen::Vector3f& direction : directions)
    rays.push_back(scan.T_world_sensor.linear().cast<float>() * direction);
  std::vector<float> ranges;
  const auto range_max = static_cast<float>(lidar.range_max_m);
  scene.castFan(position.cast<float>(), rays, range_max, ranges);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (ranges[i] < range_max) scan.points.push_back(directions[i] * ranges[i]);
  return scan;
}

/// The heading with the longest view within 60 degrees of the last one.
double nextHeading(const sim::MeshScene& scene, const Eigen::Vector3d& position, double heading) {
  constexpr int kHeadings = 61;
  std::vector<Eigen::Vector3f> rays;
  std::vector<double> headings;
  for (int i = 0; i < kHeadings; ++i) {
    headings.push_back(heading + (i - kHeadings / 2) * 2.0 * M_PI / 180.0);
    rays.emplace_back(static_cast<float>(std::cos(headings.back())),
                      static_cast<float>(std::sin(headings.back())), 0.0F);
  }
  std::vector<float> ranges;
  scene.castFan(position.cast<float>(), rays, 60.0F, ranges);
  return headings[static_cast<std::size_t>(std::max_element(ranges.begin(), ranges.end()) -
                                           ranges.begin())];
}

}  // namespace

double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double secondsOf(const std::function<void()>& work) {
  const double start = cpuSeconds();
  work();
  return cpuSeconds() - start;
}

MineWalk::MineWalk(const std::string& mesh_path, int poses)
    : mesh(sim::loadWorldMesh(mesh_path)), scene(mesh), directions(rayDirections(lidar)) {
  if (!mesh.start.has_value())
    throw OutsideError(
        "the benchmark needs a start: put \"start\": [x, y, z, yaw] into a .json "
        "beside '" +
        mesh_path + "'");
  Eigen::Vector3d position = mesh.start->position;
  double heading = mesh.start->yaw;
  for (int i = 0; i < poses; ++i) {
    scans.push_back(scanFrom(scene, lidar, directions, position, heading));
    heading = nextHeading(scene, position, heading);
    position += Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
  }
}

AxisAlignedBox noBody() { return {Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero()}; }

octomap::OcTree plainTree(const map::MapParams& params) {
  octomap::OcTree tree(params.resolution_m);
  tree.setProbHit(params.hit_probability);
  tree.setProbMiss(params.miss_probability);
  tree.setClampingThresMin(params.clamp_min_probability);
  tree.setClampingThresMax(params.clamp_max_probability);
  tree.setOccupancyThres(params.occupied_probability);
  return tree;
}

void insertPlainly(octomap::OcTree& tree, const octomap::Pointcloud& cloud, const Scan& scan,
                   const map::MapParams& params) {
  const Eigen::Vector3f origin = scan.T_world_sensor.translation().cast<float>();
  tree.insertPointCloud(cloud, {origin.x(), origin.y(), origin.z()}, params.range_max_m, false,
                        params.discretize);
}

octomap::Pointcloud worldPoints(const Scan& scan) {
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3f world = (scan.T_world_sensor * point.cast<double>()).cast<float>();
    cloud.push_back(world.x(), world.y(), world.z());
  }
  return cloud;
}

map::Occupancy statusIn(const octomap::OcTree& tree, const map::VoxelIndex& index) {
  const octomap::OcTreeKey key(static_cast<octomap::key_type>(index.x() + 32768),
                               static_cast<octomap::key_type>(index.y() + 32768),
                               static_cast<octomap::key_type>(index.z() + 32768));
  const octomap::OcTreeNode* node = tree.search(key);
  if (node == nullptr) return map::Occupancy::kUnknown;
  return tree.isNodeOccupied(node) ? map::Occupancy::kOccupied : map::Occupancy::kFree;
}

KnownMine::KnownMine(const MineWalk& walk) : tree(plainTree(params)), map(params) {
  for (const Scan& scan : walk.scans) {
    insertPlainly(tree, worldPoints(scan), scan, params);
    map.insert(scan, noBody());
  }
  middle = walk.scans[walk.scans.size() / 2].T_world_sensor.translation();
}

Eigen::Vector3d freePoint(const map::LocalWindow& window, Rng& rng, const Eigen::Vector3d& middle,
                          const Eigen::Vector3d& half_m) {
  for (int i = 0; i < 10000000; ++i) {
    const Eigen::Vector3d point =
        middle + half_m.cwiseProduct(
                     Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)));
    if (window.at(point) == map::Occupancy::kFree) return point;
  }
  throw OutsideError("the benchmark finds no free voxel around the walk");
}

}  // namespace spelunk::benchmark
