#pragma once

#include <memory>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/map/local_window.h"

namespace spelunk::map {

/// What the sensors would see from one configuration, counted in voxels along their rays. Rays end
/// at the first occupied voxel or at gain_range_m; a voxel crossed by several rays of one
/// sensor counts once a ray (Dang 2020, section 4.1, Fig. 3, do not remove the double counting)
/// or once in all, as asked.
struct VolumetricGain {
  int unknown_voxels = 0;
  int free_voxels = 0;
  int occupied_voxels = 0;
  double unknown_m3 = 0.0;
};

enum class GainCounting { kPerRay, kDistinct };

/// Casts template rays: lists of voxel offsets from a voxel's centre, computed once per sensor.
class GainEvaluator {
 public:
  GainEvaluator(const std::vector<SensorModel>& sensors, double resolution_m,
                GainCounting counting = GainCounting::kDistinct);
  ~GainEvaluator();
  GainEvaluator(GainEvaluator&&) noexcept;

  /// Gain at a pose; voxels outside `bounds` or outside the window do not count and end the ray.
  [[nodiscard]] VolumetricGain evaluate(const LocalWindow& window, const Eigen::Vector3d& position,
                                        double yaw, const AxisAlignedBox& bounds) const;

  /// The longest ray of any sensor, metres: how far a window must reach beyond the positions.
  [[nodiscard]] double reach() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
