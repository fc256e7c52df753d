#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/box.h"
#include "spelunk/common/local_frame.h"
#include "spelunk/common/pose.h"

namespace spelunk::sim {

/// A triangle mesh of a world, metres, z up. Vertices, start and all that is simulated in it are in
/// `frame`, whose caller's frame is that of the mesh file.
struct WorldMesh {
  std::string name;
  LocalFrame frame;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;  ///< Indices of vertices.
  std::optional<Pose> start;               ///< From <name>.json or the world description.
  [[nodiscard]] AxisAlignedBox bounds() const;
};

/// What decides in which frame a mesh is held: see LocalFrame::around().
struct Surroundings {
  std::optional<Eigen::Vector3d> start;  ///< Mesh file's frame; none: the mesh's own start.
  double reach_m = 0.0;
  double range_m = std::numeric_limits<double>::infinity();
};

/// Reads a .dae/.stl/.obj/.ply file; a file's unit and up-axis are honoured. Where `<name>.json`
/// lies beside it, its "start": [x, y, z, yaw] becomes the start. A warning says so if the numbers
/// of the file are coarser than a millimetre. Throws OutsideError with path and remedy if the file
/// is missing, unreadable, empty or holds no triangles.
[[nodiscard]] WorldMesh loadWorldMesh(const std::string& path, const Surroundings& around = {});

/// Writes binary STL. Throws OutsideError.
void saveStl(const WorldMesh& mesh, const std::string& path);

/// Where generated worlds are kept: $SPELUNK_CACHE, else spelunk in $XDG_CACHE_HOME, in ~/.cache
/// or, without a home, in the folder for temporary files.
[[nodiscard]] std::string defaultCacheDir();

/// A name from `worlds_dir` (worlds/<name>.yaml, generated on first use and cached in `cache_dir`,
/// an unwritable cache being no fault) or the path of a mesh file. Throws OutsideError that
/// lists the known names.
[[nodiscard]] WorldMesh openWorld(const std::string& name_or_path, const std::string& worlds_dir,
                                  const std::string& cache_dir, const Surroundings& around = {});

}  // namespace spelunk::sim
