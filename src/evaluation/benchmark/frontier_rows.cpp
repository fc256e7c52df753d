#include "bench.h"
#include "map/template_rays.h"
#include "spelunk/map/frontier_voxels.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::benchmark {
namespace {

bool isFrontier(const map::FrozenMap& map, const map::VoxelIndex& voxel) {
  if (map.at(voxel) != map::Occupancy::kFree) return false;
  for (int k = 0; k < 6; ++k) {
    map::VoxelIndex beside = voxel;
    beside(k / 2) += k % 2 == 0 ? -1 : 1;
    if (map.at(beside) == map::Occupancy::kUnknown) return true;
  }
  return false;
}

/// Every voxel of the map's extent is looked at.
bool equalsScan(const map::FrontierVoxels& frontier, const map::FrozenMap& map) {
  const AxisAlignedBox known = map.knownBounds();
  const map::VoxelIndex first = map.indexOf(known.min);
  const map::VoxelIndex last = map.indexOf(known.max);
  std::size_t count = 0;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const map::VoxelIndex voxel(x, y, z);
        const bool wanted = isFrontier(map, voxel);
        if (wanted != frontier.contains(voxel)) return false;
        count += wanted ? 1 : 0;
      }
  return count == frontier.count();
}

/// The map update itself is what the frontier's cost is held against.
Row frontierRow(const MineWalk& walk) {
  map::MapParams params;
  params.range_min_m = 0.0;
  map::OccupancyMap map(params);
  map::FrontierVoxels frontier;
  double update_s = 0.0;
  double frontier_s = 0.0;
  for (const Scan& scan : walk.scans) {
    std::shared_ptr<const map::FrozenMap> frozen;
    update_s += secondsOf([&] {
      map.insert(scan, noBody());
      frozen = map.freeze();
    });
    frontier_s += secondsOf([&] { frontier.update(frozen); });
  }
  const double to_ms = 1e3 / static_cast<double>(walk.scans.size());
  return {"frontier voxels kept up to date, 0.2 m",
          "our map update",
          "ms a scan",
          update_s * to_ms,
          frontier_s * to_ms,
          5.0,
          equalsScan(frontier, *map.freeze()),
          "every voxel of the map looked at"};
}

/// The distinct voxels of the evaluator's own rays, by search.
int distinctUnknownBySearch(const octomap::OcTree& tree, const map::TemplateRays& rays,
                            const map::VoxelIndex& start) {
  octomap::KeySet seen;
  int unknown = 0;
  for (const auto& ray : rays.rays())
    for (std::uint32_t i = ray.begin; i < ray.end; ++i) {
      const auto& step = rays.steps()[i];
      const map::VoxelIndex voxel = start + map::VoxelIndex(step[0], step[1], step[2]);
      const map::Occupancy status = statusIn(tree, voxel);
      const auto key = [&](int axis) {
        return static_cast<octomap::key_type>(voxel(axis) + 32768);
      };
      if (seen.insert(octomap::OcTreeKey(key(0), key(1), key(2))).second)
        unknown += status == map::Occupancy::kUnknown ? 1 : 0;
      if (status == map::Occupancy::kOccupied) break;
    }
  return unknown;
}

/// The same by OctoMap's own means: a ray at a time, each voxel searched, the distinct ones kept.
int distinctUnknownPlainly(const octomap::OcTree& tree, const std::vector<Eigen::Vector3f>& rays,
                           double range_m, const Eigen::Vector3d& position) {
  const octomap::point3d origin(static_cast<float>(position.x()), static_cast<float>(position.y()),
                                static_cast<float>(position.z()));
  octomap::KeyRay keys;
  octomap::KeySet unknown;
  for (const Eigen::Vector3f& ray : rays) {
    const octomap::point3d direction(ray.x(), ray.y(), ray.z());
    tree.computeRayKeys(origin, origin + direction * static_cast<float>(range_m), keys);
    for (const octomap::OcTreeKey& key : keys) {
      const octomap::OcTreeNode* node = tree.search(key);
      if (node == nullptr)
        unknown.insert(key);
      else if (tree.isNodeOccupied(node))
        break;
    }
  }
  return static_cast<int>(unknown.size());
}

Row entropyRow(KnownMine& mine) {
  SensorModel sensor;
  sensor.fov_vertical_deg = 178.0;
  sensor.gain_range_m = 4.0;
  sensor.gain_resolution_deg = 3.0;  // neighbouring rays end a voxel apart
  SensorModel plain_sensor = sensor;
  plain_sensor.columns = 120;
  plain_sensor.rows = 60;
  const map::GainEvaluator evaluator({sensor}, mine.params.resolution_m,
                                     map::GainCounting::kDistinct);
  const map::TemplateRays rays(sensor, mine.params.resolution_m);
  const auto frozen = mine.map.freeze();
  const map::LocalWindow middle(*frozen, boxAround(mine.middle, {21.0, 21.0, 7.0}));
  constexpr int kCandidates = 100;
  constexpr int kPlainCandidates = 10;
  Rng rng(6);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kCandidates; ++i)
    places.push_back(freePoint(middle, rng, mine.middle, {10.0, 10.0, 2.0}));
  const auto gainAt = [&](const Eigen::Vector3d& place) {
    const Eigen::Vector3d centre = frozen->centreOf(frozen->indexOf(place));
    const double side = 2.0 * evaluator.reach();
    const map::LocalWindow window(*frozen, boxAround(centre, Eigen::Vector3d::Constant(side)));
    return evaluator.evaluate(window, place, 0.0, AxisAlignedBox{}).unknown_voxels;
  };
  int sum = gainAt(places[0]);  // the evaluator fits its lists to the window's size at first use
  const std::vector<Eigen::Vector3f> directions = rayDirections(plain_sensor);
  const double plain_s = secondsOf([&] {
    for (std::size_t i = 0; i < kPlainCandidates; ++i)
      sum += distinctUnknownPlainly(mine.tree, directions, sensor.gain_range_m, places[i]);
  });
  std::vector<int> gains;
  const double ours_s = secondsOf([&] {
    for (const Eigen::Vector3d& place : places) gains.push_back(gainAt(place));
  });
  bool is_equal = sum >= 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    is_equal = is_equal &&
               gains[i] == distinctUnknownBySearch(mine.tree, rays, frozen->indexOf(places[i]));
  return {"entropy gain of distinct voxels, all around, 4 m",
          "computeRayKeys + search",
          "us a candidate",
          plain_s * 1e6 / kPlainCandidates,
          ours_s * 1e6 / kCandidates,
          50.0,
          is_equal,
          "the distinct voxels of the same lists by search"};
}

}  // namespace

std::vector<Row> frontierRows(const MineWalk& walk, KnownMine& mine) {
  return {frontierRow(walk), entropyRow(mine)};
}

}  // namespace spelunk::benchmark
