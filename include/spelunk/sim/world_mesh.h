#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/pose.h"

namespace spelunk::sim {

/// A triangle mesh of a world, metres, z up, world frame.
struct WorldMesh {
  std::string name;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;  ///< Indices of vertices.
  std::optional<Pose> start;               ///< From <name>.json or the world description.
  [[nodiscard]] AxisAlignedBox bounds() const;
};

/// Reads a .dae/.stl/.obj/.ply file; a file's unit and up-axis are honoured. Where `<name>.json`
/// lies beside it, its "start": [x, y, z, yaw] becomes the start. Throws OutsideError with path and
/// remedy if the file is missing, unreadable, empty or holds no triangles.
[[nodiscard]] WorldMesh loadWorldMesh(const std::string& path);

/// Writes binary STL. Throws OutsideError.
void saveStl(const WorldMesh& mesh, const std::string& path);

/// Where generated worlds are kept: $SPELUNK_CACHE, else spelunk in $XDG_CACHE_HOME, in ~/.cache
/// or, without a home, in the folder for temporary files.
[[nodiscard]] std::string defaultCacheDir();

/// A name from `worlds_dir` (worlds/<name>.yaml, generated on first use and cached in `cache_dir`,
/// an unwritable cache being no fault) or the path of a mesh file. Throws OutsideError that
/// lists the known names.
[[nodiscard]] WorldMesh openWorld(const std::string& name_or_path, const std::string& worlds_dir,
                                  const std::string& cache_dir);

}  // namespace spelunk::sim
