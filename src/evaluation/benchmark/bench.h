#pragma once

#include <octomap/OcTree.h>

#include <functional>
#include <string>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/common/scan.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/map/local_window.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::benchmark {

/// CPU time of this process, seconds: what a loaded machine does not spoil.
double cpuSeconds();

/// CPU seconds `work` takes.
double secondsOf(const std::function<void()>& work);

/// One line of the table. Times are totals over the same work.
struct Row {
  std::string operation;
  std::string against;
  std::string unit;  ///< Of the two times, for instance "ms a scan".
  double plain = 0.0;
  double ours = 0.0;
  double floor = 0.0;     ///< The ratio that must hold.
  bool is_equal = false;  ///< The answers of both ways, by the row's own definition.
  std::string equality;   ///< What was compared.

  [[nodiscard]] double ratio() const { return plain / ours; }
};

/// The mesh and what a LiDAR on a walk through its gallery sees, one scan a metre.
struct MineWalk {
  MineWalk(const std::string& mesh_path, int poses);

  sim::WorldMesh mesh;
  sim::MeshScene scene;
  SensorModel lidar;
  std::vector<Eigen::Vector3f> directions;
  std::vector<Scan> scans;
};

/// No body: nothing is dropped as a self-hit.
AxisAlignedBox noBody();

/// An OcTree with the map's sensor model.
octomap::OcTree plainTree(const map::MapParams& params);
/// The plain way: insertPointCloud, every inner node kept up to date.
void insertPlainly(octomap::OcTree& tree, const octomap::Pointcloud& cloud, const Scan& scan,
                   const map::MapParams& params);
/// The scan's points in the world frame, rounded as the map rounds them.
octomap::Pointcloud worldPoints(const Scan& scan);
/// Status by OcTree::search.
map::Occupancy statusIn(const octomap::OcTree& tree, const map::VoxelIndex& index);

/// The map after all scans of the walk, both ways, and the middle of it.
struct KnownMine {
  explicit KnownMine(const MineWalk& walk);

  map::MapParams params;
  octomap::OcTree tree;
  map::OccupancyMap map;
  Eigen::Vector3d middle;
};

std::vector<Row> mapRows(const MineWalk& walk);
std::vector<Row> statusRows(KnownMine& mine);
std::vector<Row> edgeRows(KnownMine& mine);
std::vector<Row> gainRows(KnownMine& mine);
std::vector<Row> planRows(KnownMine& mine);
std::vector<Row> lidarRows(const MineWalk& walk);
std::vector<Row> terrainRows(const MineWalk& walk);
std::vector<Row> navigationRows(KnownMine& mine);

/// Every voxel the box touches, by search; half extents less 0.1 mm.
bool isBoxFreePlainly(const octomap::OcTree& tree, const Eigen::Vector3d& centre,
                      const Eigen::Vector3d& size);
/// The box moved from a to b, looked at by search at a, whenever it enters a new layer of voxels
/// (then are its answers able to change), and at b.
bool isSweepFreePlainly(const octomap::OcTree& tree, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& size);
/// Unknown voxels along the rays of a full-circle sensor, by computeRayKeys and search.
int unknownVoxelsPlainly(const octomap::OcTree& tree, const SensorModel& sensor,
                         const Eigen::Vector3d& position);
/// A random point whose voxel is free, within `half_m` of `middle`.
Eigen::Vector3d freePoint(const map::LocalWindow& window, Rng& rng, const Eigen::Vector3d& middle,
                          const Eigen::Vector3d& half_m);

}  // namespace spelunk::benchmark
