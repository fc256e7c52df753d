#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "spelunk/common/rng.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/simulator.h"
#include "spelunk/sim/world_events.h"

namespace spelunk::sim {

/// One LiDAR or depth camera on the robot. All rays of a scan leave at the scan's instant.
class RangeSensor {
 public:
  /// `dust_returns` is the mean share of rays that end early in dust. A hoop of radius
  /// `hoop_radius_m` around the base's vertical axis, at the sensor's height, ends the rays that
  /// meet it; 0: there is none.
  RangeSensor(const SensorModel& model, double dust_returns, const Rng& rng,
              double hoop_radius_m = 0.0);

  /// Time of the next scan, seconds: the n-th lies at n / rate.
  [[nodiscard]] double nextScanTime() const;

  /// From now on scan() casts only those scans that enter a map.
  void castOnlyMapped() { thinning_.emplace(model_.mapping_period_s); }

  /// Takes the next scan; nothing if it is one that need not be cast. `T_world_base_true` places
  /// the rays, `T_world_base_odometry` is what the robot believes. Rays end at the obstacles of
  /// `events`, too.
  std::optional<SimulatedScan> scan(const MeshScene& scene,
                                    const Eigen::Isometry3d& T_world_base_true,
                                    const Eigen::Isometry3d& T_world_base_odometry, double stamp_s,
                                    const WorldEvents& events = WorldEvents());

 private:
  std::vector<Eigen::Vector3f> disturbedPoints(const std::vector<float>& ranges,
                                               std::uint64_t scan_key) const;

  SensorModel model_;
  double dust_returns_;
  std::uint64_t key_;
  Eigen::Isometry3d T_base_sensor_;
  std::shared_ptr<const std::vector<Eigen::Vector3f>> directions_;
  std::vector<float> hoop_ranges_;                 ///< One a direction; empty without a hoop.
  std::vector<Eigen::Vector3f> world_directions_;  ///< Scratch.
  std::uint64_t scans_taken_ = 0;
  std::optional<ScanThinning> thinning_;
};

}  // namespace spelunk::sim
