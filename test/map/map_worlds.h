#pragma once

#include <octomap/OcTree.h>

#include <cmath>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/rng.h"
#include "spelunk/common/scan.h"
#include "spelunk/map/occupancy_map.h"

namespace spelunk::map {

/// No body: nothing is dropped as a self-hit.
inline AxisAlignedBox noBody() { return {Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero()}; }

/// A hall with two pillars, as rays see it.
class PillarHall {
 public:
  [[nodiscard]] double rangeOf(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    double range = exitOf(hall_, origin, ray);
    for (const AxisAlignedBox& pillar : pillars_)
      range = std::min(range, entryOf(pillar, origin, ray));
    return range;
  }

 private:
  static double exitOf(const AxisAlignedBox& box, const Eigen::Vector3d& o,
                       const Eigen::Vector3d& d) {
    double exit = 1e9;
    for (int i = 0; i < 3; ++i)
      if (d(i) != 0.0)
        exit = std::min(exit, ((d(i) > 0.0 ? box.max(i) : box.min(i)) - o(i)) / d(i));
    return exit;
  }
  static double entryOf(const AxisAlignedBox& box, const Eigen::Vector3d& o,
                        const Eigen::Vector3d& d) {
    double entry = 0.0;
    for (int i = 0; i < 3; ++i)
      if (d(i) != 0.0)
        entry = std::max(entry, ((d(i) > 0.0 ? box.min(i) : box.max(i)) - o(i)) / d(i));
    const Eigen::Vector3d at = o + d * (entry + 1e-9);
    return entry > 0.0 && box.contains(at) ? entry : 1e9;
  }

  AxisAlignedBox hall_{{-9.0, -4.0, -0.7}, {11.0, 5.0, 2.9}};
  std::vector<AxisAlignedBox> pillars_{{{1.0, -1.5, -1.0}, {1.9, -0.6, 3.0}},
                                       {{4.0, 1.0, -1.0}, {4.5, 3.0, 1.6}}};
};

/// A scan of the hall from a tilted sensor, with noise and with points that need cleaning.
inline Scan hallScan(Rng& rng, const Eigen::Vector3d& position, int rays) {
  const PillarHall hall;
  Scan scan;
  scan.T_world_sensor.translate(position.cast<float>().cast<double>().eval());
  scan.T_world_sensor.rotate(Eigen::AngleAxisd(rng.uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(rng.uniform(-0.2, 0.2), Eigen::Vector3d::UnitX()));
  for (int i = 0; i < rays; ++i) {
    const double azimuth = rng.uniform(-M_PI, M_PI);
    const double elevation = rng.uniform(-0.5, 0.5);
    const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const double range = hall.rangeOf(position, scan.T_world_sensor.linear() * ray);
    scan.points.push_back((ray * (range + 0.02 * rng.normal())).cast<float>());
  }
  return scan;
}

/// Where the sensor is at the i-th of many scans.
inline Eigen::Vector3d hallPosition(int i) {
  return {-7.0 + 0.61 * i, 0.9 * std::sin(0.5 * i) - 0.01, 0.8 + 0.1 * std::cos(0.7 * i)};
}

/// The points in the world frame as the map rounds them.
inline octomap::Pointcloud worldPoints(const Scan& scan) {
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3f world = (scan.T_world_sensor * point.cast<double>()).cast<float>();
    cloud.push_back(world.x(), world.y(), world.z());
  }
  return cloud;
}

inline octomap::OcTree emptyTree(const MapParams& params) {
  octomap::OcTree tree(params.resolution_m);
  tree.setProbHit(params.hit_probability);
  tree.setProbMiss(params.miss_probability);
  tree.setClampingThresMin(params.clamp_min_probability);
  tree.setClampingThresMax(params.clamp_max_probability);
  tree.setOccupancyThres(params.occupied_probability);
  return tree;
}

inline void insertPlainly(octomap::OcTree& tree, const Scan& scan, const MapParams& params) {
  const Eigen::Vector3f origin = scan.T_world_sensor.translation().cast<float>();
  tree.insertPointCloud(worldPoints(scan), {origin.x(), origin.y(), origin.z()}, params.range_max_m,
                        false, params.discretize);
}

inline Occupancy statusIn(const octomap::OcTree& tree, const VoxelIndex& index) {
  const octomap::OcTreeKey key(static_cast<octomap::key_type>(index.x() + 32768),
                               static_cast<octomap::key_type>(index.y() + 32768),
                               static_cast<octomap::key_type>(index.z() + 32768));
  const octomap::OcTreeNode* node = tree.search(key);
  if (node == nullptr) return Occupancy::kUnknown;
  return tree.isNodeOccupied(node) ? Occupancy::kOccupied : Occupancy::kFree;
}

/// A map of the hall after `scans` scans.
inline OccupancyMap hallMap(const MapParams& params, int scans, int rays, std::uint64_t seed) {
  Rng rng(seed);
  OccupancyMap map(params);
  for (int i = 0; i < scans; ++i) map.insert(hallScan(rng, hallPosition(i), rays), noBody());
  return map;
}

/// A map whose voxels in a cube of `side` voxels from index 0 are set at random, each by enough
/// single-point scans; `occupied` and `unknown` are shares.
inline AxisAlignedBox voxelBox(const VoxelIndex& index, double resolution_m) {
  return {(index.cast<double>().array() + 0.25) * resolution_m,
          (index.cast<double>().array() + 0.75) * resolution_m};
}

/// Makes one voxel occupied: a short hit from the centre of the voxel below it.
inline void occupy(OccupancyMap& map, const VoxelIndex& index) {
  const double r = map.params().resolution_m;
  Scan scan;
  scan.T_world_sensor.translate(Eigen::Vector3d((index.cast<double>().array() + 0.5) * r) +
                                Eigen::Vector3d(0.0, 0.0, 1e-3));
  scan.points.emplace_back(1e-4F, 0.0F, 0.0F);
  for (int i = 0; i < 3; ++i) map.insert(scan, noBody());
}

/// Random free and occupied voxels in a cube from index 0 on; the rest stays unknown.
inline OccupancyMap randomMap(const MapParams& wanted, Rng& rng, const VoxelIndex& size,
                              double occupied, double unknown) {
  MapParams params = wanted;
  params.range_min_m = 0.0;
  OccupancyMap map(params);
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const double draw = rng.uniform();
        if (draw < occupied)
          occupy(map, {x, y, z});
        else if (draw > occupied + unknown)
          map.markFree(voxelBox({x, y, z}, params.resolution_m));
      }
  return map;
}

}  // namespace spelunk::map
