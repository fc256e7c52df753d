#pragma once

#include <vector>

#include "ray_walks.h"
#include "scan_marks.h"

namespace spelunk::map {

/// The voxels OctoMap would update for one scan (Hornung et al., OctoMap, Autonomous Robots 2013,
/// section 5): same arithmetic, so the same voxels bit for bit.
class ScanTracer {
 public:
  /// The origin's key must be in range with a margin of one block. The rays taken are written to
  /// `walks`, which is emptied first.
  ScanTracer(const Eigen::Vector3f& origin, double resolution_m, double range_max_m,
             std::vector<RayWalk>& walks);

  /// Takes the ray to `end`: free up to it and hit at it, or free up to the range if it is longer.
  /// Marks the hit at once. `end` must be in key range with a margin of one block.
  void add(const Eigen::Vector3f& end, ScanMarks& marks);

  /// Takes the ray to the centre of the voxel around `end` instead, unless `ends` says that one to
  /// this voxel was taken: OctoMap's discretization.
  void addOnce(const Eigen::Vector3f& end, ScanMarks& ends, ScanMarks& marks);

  /// The centre of the voxel around `point`, as OctoMap rounds it.
  [[nodiscard]] Eigen::Vector3f centreAround(const Eigen::Vector3f& point) const;

 private:
  [[nodiscard]] VoxelIndex indexOf(const Eigen::Vector3f& point) const;
  [[nodiscard]] Eigen::Vector3f centreOf(const VoxelIndex& index) const;
  void addWithin(const Eigen::Vector3f& end, const VoxelIndex& voxel, ScanMarks& marks);
  void addWalk(const Eigen::Vector3f& end, const VoxelIndex& voxel);

  Eigen::Vector3f origin_;
  double resolution_m_;
  double inverse_resolution_;
  double range_max_m_;
  VoxelIndex origin_index_;
  std::vector<RayWalk>& walks_;
};

}  // namespace spelunk::map
