#pragma once

#include <Eigen/Geometry>
#include <array>

#include "spelunk/common/pose.h"
#include "spelunk/sim/foothold_search.h"
#include "spelunk/sim/walker_params.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// A trunk and four feet at rest on the ground.
struct Stance {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  std::array<Foothold, kLegs> holds;
};

/// The stance on the ground below `start`. Throws OutsideError with the reason and the remedy if
/// there is no ground within 1.5 m, a foot finds no place, the ground is too steep or the trunk
/// meets the mesh.
[[nodiscard]] Stance standBelow(const MeshScene& scene, const WorldMesh& mesh,
                                const WalkerParams& params, const Pose& start);

}  // namespace spelunk::sim
