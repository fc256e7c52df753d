#include <cmath>

#include "bench.h"
#include "map/template_rays.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::benchmark {
namespace {

/// What the evaluator's own voxel lists give by search.
map::VolumetricGain gainBySearch(const octomap::OcTree& tree, const map::TemplateRays& rays,
                                 const map::VoxelIndex& start) {
  map::VolumetricGain gain;
  for (const auto& ray : rays.rays())
    for (std::uint32_t i = ray.begin; i < ray.end; ++i) {
      const auto& step = rays.steps()[i];
      const map::Occupancy status =
          statusIn(tree, start + map::VoxelIndex(step[0], step[1], step[2]));
      gain.unknown_voxels += status == map::Occupancy::kUnknown ? 1 : 0;
      gain.free_voxels += status == map::Occupancy::kFree ? 1 : 0;
      gain.occupied_voxels += status == map::Occupancy::kOccupied ? 1 : 0;
      if (status == map::Occupancy::kOccupied) break;
    }
  return gain;
}

Row gainRow(KnownMine& mine, double range_m, double floor) {
  SensorModel sensor;
  sensor.gain_range_m = range_m;
  const double side = 2.0 * range_m + 21.0;
  const double height = 2.0 * std::ceil(range_m * std::sin(M_PI / 12.0)) + 7.0;
  const map::LocalWindow window(*mine.map.freeze(), boxAround(mine.middle, {side, side, height}));
  const map::GainEvaluator evaluator({sensor}, mine.params.resolution_m,
                                     map::GainCounting::kPerRay);
  const map::TemplateRays rays(sensor, mine.params.resolution_m);
  constexpr int kVertices = 200;
  constexpr int kPlainVertices = 40;
  Rng rng(5);
  std::vector<Eigen::Vector3d> vertices;
  for (int i = 0; i < kVertices; ++i)
    vertices.push_back(freePoint(window, rng, mine.middle, {10.0, 10.0, 2.0}));
  int sum = 0;
  // The evaluator fits its lists to the window's size at first use.
  static_cast<void>(evaluator.evaluate(window, vertices[0], 0.0, AxisAlignedBox{}));
  const double plain_s = secondsOf([&] {
    for (int i = 0; i < kPlainVertices; ++i)
      sum += unknownVoxelsPlainly(mine.tree, sensor, vertices[static_cast<std::size_t>(i)]);
  });
  std::vector<map::VolumetricGain> gains;
  const double ours_s = secondsOf([&] {
    for (const Eigen::Vector3d& vertex : vertices)
      gains.push_back(evaluator.evaluate(window, vertex, 0.0, AxisAlignedBox{}));
  });
  bool is_equal = sum >= 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const map::VolumetricGain wanted = gainBySearch(mine.tree, rays, window.indexOf(vertices[i]));
    is_equal = is_equal && wanted.unknown_voxels == gains[i].unknown_voxels &&
               wanted.free_voxels == gains[i].free_voxels &&
               wanted.occupied_voxels == gains[i].occupied_voxels;
  }
  return {"volumetric gain, 5 x 5 degrees, " + std::to_string(static_cast<int>(range_m)) + " m",
          "computeRayKeys + search",
          "us a vertex",
          plain_s * 1e6 / kPlainVertices,
          ours_s * 1e6 / kVertices,
          floor,
          is_equal,
          "the same voxel lists by search"};
}

}  // namespace

int unknownVoxelsPlainly(const octomap::OcTree& tree, const SensorModel& sensor,
                         const Eigen::Vector3d& position) {
  constexpr double kDegree = M_PI / 180.0;
  const octomap::point3d origin(static_cast<float>(position.x()), static_cast<float>(position.y()),
                                static_cast<float>(position.z()));
  octomap::KeyRay keys;
  int unknown = 0;
  for (int column = 0; column < 72; ++column)
    for (int row = 0; row < 7; ++row) {
      const double azimuth = column * 5.0 * kDegree;
      const double elevation = (row * 5.0 - 15.0) * kDegree;
      const octomap::point3d direction(static_cast<float>(std::cos(elevation) * std::cos(azimuth)),
                                       static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
                                       static_cast<float>(std::sin(elevation)));
      tree.computeRayKeys(origin, origin + direction * static_cast<float>(sensor.gain_range_m),
                          keys);
      for (const octomap::OcTreeKey& key : keys) {
        const octomap::OcTreeNode* node = tree.search(key);
        if (node == nullptr)
          ++unknown;
        else if (tree.isNodeOccupied(node))
          break;
      }
    }
  return unknown;
}

std::vector<Row> gainRows(KnownMine& mine) {
  return {gainRow(mine, 20.0, 50.0), gainRow(mine, 50.0, 40.0)};
}

}  // namespace spelunk::benchmark
