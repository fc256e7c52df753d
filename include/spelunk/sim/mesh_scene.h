#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// Where a ray meets the world.
struct RayHit {
  double range_m = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit, towards the ray's origin.
};

/// The world as rays and distances see it (Embree; stays inside the .cpp). Its instruction set is
/// pinned so that the same rays give the same ranges on every machine.
class MeshScene {
 public:
  explicit MeshScene(const WorldMesh& mesh);
  ~MeshScene();
  MeshScene(MeshScene&&) noexcept;

  /// Ranges of rays that share one origin, in the order given; `range_max` where nothing is hit.
  /// Directions are unit vectors in the world frame. `ranges` is resized.
  void castFan(const Eigen::Vector3f& origin, const std::vector<Eigen::Vector3f>& directions,
               float range_max, std::vector<float>& ranges) const;

  /// The first triangle a single ray meets within `range_max`; `direction` is a unit vector.
  [[nodiscard]] std::optional<RayHit> castRay(const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& direction,
                                              double range_max) const;

  /// Distance from a point to the nearest triangle, metres, exact up to `limit_m` (then the limit).
  [[nodiscard]] double distanceTo(const Eigen::Vector3d& point, double limit_m) const;

  /// Distance from an axis-aligned box (full extents) to the nearest triangle; 0 if it meets one.
  [[nodiscard]] double boxDistance(const Eigen::Vector3d& centre, const Eigen::Vector3d& size,
                                   double limit_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::sim
