#pragma once

#include <vector>

#include "ray_walks.h"
#include "scan_marks.h"

namespace spelunk::map {

/// The voxels OctoMap would update for one scan (Hornung et al., OctoMap, Autonomous Robots 2013,
/// section 5): same arithmetic, so the same voxels bit for bit.
class ScanTracer {
 public:
  /// The origin's key must be in range with a margin of one block.
  ScanTracer(const Eigen::Vector3f& origin, double resolution_m, double range_max_m);

  void reserve(std::size_t rays) { walks_.reserve(rays); }

  /// Takes the ray to `end`: free up to it and hit at it, or free up to the range if it is longer.
  /// Marks the hit at once. `end` must be in key range with a margin of one block.
  void add(const Eigen::Vector3f& end, ScanMarks& marks);

  /// The rays taken.
  [[nodiscard]] const std::vector<RayWalk>& walks() const { return walks_; }

  /// The centre of the voxel around `point`, as OctoMap rounds it.
  [[nodiscard]] Eigen::Vector3f centreAround(const Eigen::Vector3f& point) const;
  [[nodiscard]] PackedKey keyOf(const Eigen::Vector3f& point) const;

 private:
  [[nodiscard]] VoxelIndex indexOf(const Eigen::Vector3f& point) const;
  void addWalk(const Eigen::Vector3f& end);

  Eigen::Vector3f origin_;
  double resolution_m_;
  double inverse_resolution_;
  double range_max_m_;
  VoxelIndex origin_index_;
  std::vector<RayWalk> walks_;
};

}  // namespace spelunk::map
