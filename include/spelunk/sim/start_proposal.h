#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "spelunk/common/pose.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::sim {

/// A free place for a box of `size_m` near a floor of the mesh, walled in on as many sides as can
/// be found; none if no place beside the mesh's triangles has room. The same mesh gives the same
/// place.
[[nodiscard]] std::optional<Pose> proposeStart(const WorldMesh& mesh,
                                               const Eigen::Vector3d& size_m);

/// For a world without a start: what it is like, a free place, and how to say it.
/// `option` is how the program is told a start, as "--start ".
[[nodiscard]] std::string missingStartText(const WorldMesh& mesh, const Eigen::Vector3d& size_m,
                                           const std::string& option);

/// The start that is told (world frame), else the world's own, in the frame of the mesh. Throws
/// OutsideError with missingStartText() if there is none.
[[nodiscard]] Pose chooseStart(const WorldMesh& mesh, const std::optional<Pose>& told,
                               const Eigen::Vector3d& size_m, const std::string& option);

}  // namespace spelunk::sim
