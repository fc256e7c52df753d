#pragma once

#include <vector>

#include "spelunk/map/local_window.h"

namespace spelunk::map {

/// Distance to the nearest occupied voxel centre, exact up to a limit (truncated Euclidean distance
/// transform). Distances are between voxel centres.
class ClearanceField {
 public:
  ClearanceField(const LocalWindow& window, double limit_m);

  /// Metres, at most the limit; the limit outside the window.
  [[nodiscard]] double at(const Eigen::Vector3d& point) const;
  [[nodiscard]] double limit() const { return limit_m_; }

 private:
  VoxelIndex origin_;
  VoxelIndex size_;
  double resolution_m_;
  double limit_m_;
  std::vector<float> distance_m_;
};

}  // namespace spelunk::map
