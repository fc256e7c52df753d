#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/map/local_window.h"

namespace spelunk::map {

/// What the sensors would see from one configuration, counted in voxels along their rays. Rays end
/// at the first occupied voxel or at gainRange().
struct VolumetricGain {
  int unknown_voxels = 0;
  int free_voxels = 0;
  int occupied_voxels = 0;
  double unknown_m3 = 0.0;
};

/// How unknown voxels on rays add up to a volume.
enum class GainCounting {
  kPerRay,    ///< A voxel counts once for each ray that crosses it: Dang 2020, section 4.1, Fig. 3,
              ///< does not remove the double counting. Voxels near by count many times, far ones
              ///< stand for what lies between the rays as well.
  kDistinct,  ///< A voxel counts once.
  kCone       ///< Each ray stands for its share of the field of view: a voxel on it counts as much
              ///< volume as the share holds between its two ends. The sum over an open field is the
              ///< field's volume, whatever the angle between the rays.
};

/// Casts template rays: lists of voxel offsets from a voxel's centre, computed once per sensor.
class GainEvaluator {
 public:
  /// `cone_depth_m`: with kCone, how far beyond the first unknown voxel a ray counts. Rock is as
  /// likely as a gallery behind a pocket near a wall; a wide opening counts by its many rays.
  GainEvaluator(const std::vector<SensorModel>& sensors, double resolution_m,
                GainCounting counting = GainCounting::kDistinct,
                double cone_depth_m = std::numeric_limits<double>::infinity());
  ~GainEvaluator();
  GainEvaluator(GainEvaluator&&) noexcept;

  /// Gain at a pose; voxels outside `bounds` or outside the window do not count and end the ray.
  [[nodiscard]] VolumetricGain evaluate(const LocalWindow& window, const Eigen::Vector3d& position,
                                        double yaw, const AxisAlignedBox& bounds) const;

  /// The longest ray of any sensor, metres: how far a window must reach beyond the positions.
  [[nodiscard]] double reach() const;

  /// The same up and down alone: how much higher or lower than the position a ray may end.
  [[nodiscard]] double reachInHeight() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::map
