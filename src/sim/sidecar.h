#pragma once

#include <filesystem>
#include <optional>

#include "spelunk/common/box.h"
#include "spelunk/common/pose.h"
#include "spelunk/sim/mesh_frame.h"

namespace spelunk::sim {

/// What `<name>.json` beside a mesh says. Places are in the world frame, after scale and up.
struct Sidecar {
  std::optional<Pose> start;             ///< "start": [x, y, z, yaw]
  MeshFrame frame;                       ///< "scale": metres a unit; "up": "x", "y" or "z"
  std::optional<AxisAlignedBox> bounds;  ///< "bounds": [[x, y, z], [x, y, z]], of exploration
};

/// Reads the file beside a mesh; nothing is said if there is none. "artifacts" is for others; keys
/// that are not known are named in a warning and not used. Throws OutsideError with path, key and
/// remedy if the file is no JSON object or a value is of another kind.
[[nodiscard]] Sidecar readSidecar(const std::filesystem::path& mesh_path);

}  // namespace spelunk::sim
