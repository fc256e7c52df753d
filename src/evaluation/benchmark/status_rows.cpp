#include "bench.h"
#include "map/template_rays.h"

namespace spelunk::benchmark {
namespace {

/// Voxels along the rays of a sensor standing at free places, in the order a planner meets them.
std::vector<map::VoxelIndex> voxelsAlongRays(const map::LocalWindow& window,
                                             const Eigen::Vector3d& middle) {
  SensorModel sensor;
  const map::TemplateRays rays(sensor, window.resolution());
  Rng rng(3);
  std::vector<map::VoxelIndex> voxels;
  for (int place = 0; place < 10; ++place) {
    const map::VoxelIndex start = window.indexOf(freePoint(window, rng, middle, {10.0, 10.0, 2.0}));
    for (const auto& ray : rays.rays())
      for (std::uint32_t i = ray.begin; i < ray.end; ++i) {
        const auto& step = rays.steps()[i];
        const map::VoxelIndex at = start + map::VoxelIndex(step[0], step[1], step[2]);
        const map::VoxelIndex local = at - window.origin();
        if ((local.array() < 0).any() || (local.array() >= window.size().array()).any()) break;
        voxels.push_back(at);
        if (window.at(at) == map::Occupancy::kOccupied) break;
      }
  }
  return voxels;
}

}  // namespace

std::vector<Row> statusRows(KnownMine& mine) {
  const map::LocalWindow window(*mine.map.freeze(), boxAround(mine.middle, {40.0, 40.0, 6.0}));
  const std::vector<map::VoxelIndex> voxels = voxelsAlongRays(window, mine.middle);
  constexpr int kRounds = 5;
  double plain_s = 0.0;
  double ours_s = 0.0;
  bool is_equal = true;
  for (int round = 0; round < kRounds; ++round) {
    std::size_t plain_sum = 0;
    std::size_t ours_sum = 0;
    plain_s += secondsOf([&] {
      for (const map::VoxelIndex& voxel : voxels)
        plain_sum += static_cast<std::size_t>(statusIn(mine.tree, voxel));
    });
    ours_s += secondsOf([&] {
      for (const map::VoxelIndex& voxel : voxels)
        ours_sum += static_cast<std::size_t>(window.at(voxel));
    });
    is_equal = is_equal && plain_sum == ours_sum;
  }
  for (const map::VoxelIndex& voxel : voxels)
    is_equal = is_equal && statusIn(mine.tree, voxel) == window.at(voxel);
  const double to_ns = 1e9 / static_cast<double>(voxels.size() * kRounds);
  return {{"voxel status along rays", "OcTree::search", "ns a voxel", plain_s * to_ns,
           ours_s * to_ns, 20.0, is_equal, "each voxel"}};
}

}  // namespace spelunk::benchmark
