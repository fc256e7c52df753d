#include "bench.h"

namespace spelunk::benchmark {
namespace {

struct Totals {
  double plain_s = 0.0;
  double tree_s = 0.0;  ///< Ours, the OcTree brought up to date after every scan.
  double grid_s = 0.0;  ///< Ours, the blocks and the frozen view only.
  bool trees_equal = true;
  bool grids_equal = true;
};

bool haveSameVoxels(const octomap::OcTree& tree, const map::FrozenMap& grid) {
  std::size_t free = 0;
  std::size_t occupied = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int side = 1 << (16 - leaf.getDepth());
    const bool is_occupied = tree.isNodeOccupied(*leaf);
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const map::VoxelIndex index =
              map::VoxelIndex(first[0], first[1], first[2]).array() - 32768;
          const map::VoxelIndex at = index + map::VoxelIndex(x, y, z);
          const auto wanted = is_occupied ? map::Occupancy::kOccupied : map::Occupancy::kFree;
          if (grid.at(at) != wanted) return false;
          ++(is_occupied ? occupied : free);
        }
  }
  return free == grid.freeVoxels() && occupied == grid.occupiedVoxels();
}

Totals compareUpdates(const MineWalk& walk, const map::MapParams& params, std::size_t scans) {
  Totals totals;
  octomap::OcTree plain = plainTree(params);
  map::OccupancyMap with_tree(params);
  map::OccupancyMap grid_only(params);
  for (std::size_t i = 0; i < scans; ++i) {
    const Scan& scan = walk.scans[i];
    const octomap::Pointcloud cloud = worldPoints(scan);
    totals.plain_s += secondsOf([&] { insertPlainly(plain, cloud, scan, params); });
    totals.tree_s += secondsOf([&] {
      with_tree.insert(scan, noBody());
      static_cast<void>(with_tree.octree());
    });
    totals.grid_s += secondsOf([&] {
      grid_only.insert(scan, noBody());
      static_cast<void>(grid_only.freeze());
    });
    if (i % 10 == 9 || i + 1 == scans)
      totals.trees_equal = totals.trees_equal && with_tree.octree() == plain;
  }
  totals.grids_equal = haveSameVoxels(plain, *grid_only.freeze());
  return totals;
}

}  // namespace

std::vector<Row> mapRows(const MineWalk& walk) {
  std::vector<Row> rows;
  for (const double resolution_m : {0.2, 0.1})
    for (const bool discretize : {true, false}) {
      map::MapParams params;
      params.resolution_m = resolution_m;
      params.discretize = discretize;
      params.range_min_m = 0.0;
      const bool is_coarse = resolution_m > 0.15;
      const std::size_t scans = std::min<std::size_t>(walk.scans.size(), is_coarse ? 40 : 10);
      const Totals totals = compareUpdates(walk, params, scans);
      const double to_ms = 1e3 / static_cast<double>(scans);
      const std::string what = std::string(is_coarse ? "0.2 m" : "0.1 m") +
                               (discretize ? ", one ray a hit voxel" : ", every ray");
      rows.push_back({"map update with the OcTree, " + what, "insertPointCloud", "ms a scan",
                      totals.plain_s * to_ms, totals.tree_s * to_ms, is_coarse ? 6.0 : 8.0,
                      totals.trees_equal, "every node, inner ones too"});
      rows.push_back({"map update of the planner's grid, " + what, "insertPointCloud", "ms a scan",
                      totals.plain_s * to_ms, totals.grid_s * to_ms, 9.0, totals.grids_equal,
                      "status of every voxel"});
    }
  return rows;
}

}  // namespace spelunk::benchmark
