#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "spelunk/sim/leg_kinematics.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/walker_params.h"

namespace spelunk::sim {

/// A place for a foot on the mesh, world frame.
struct Foothold {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Finds places for feet on the true mesh.
class FootholdSearch {
 public:
  /// Keeps a reference to `scene`.
  FootholdSearch(const MeshScene& scene, const WalkerParams& params);

  /// The acceptable place nearest to `wanted` (its height does not matter) with the trunk at
  /// `T_world_base`: within the leg's reach, not behind rock, not too steep. A place whose
  /// surroundings are flat is preferred to an edge. Nothing if there is none in the search radius.
  [[nodiscard]] std::optional<Foothold> find(const Leg& leg, const Eigen::Isometry3d& T_world_base,
                                             const Eigen::Vector3d& wanted) const;

  /// The ground below `from` within `depth_m`, however steep.
  [[nodiscard]] std::optional<Foothold> groundBelow(const Eigen::Vector3d& from,
                                                    double depth_m) const;

  /// Whether the straight way between two points meets the mesh.
  [[nodiscard]] bool isRockBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

 private:
  [[nodiscard]] std::optional<Foothold> reachable(const Leg& leg,
                                                  const Eigen::Isometry3d& T_world_base,
                                                  const Eigen::Vector3d& wanted) const;
  [[nodiscard]] bool isFlatAround(const Foothold& foothold) const;

  const MeshScene& scene_;
  double search_m_;
  double normal_z_min_;
};

}  // namespace spelunk::sim
