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
#include "spelunk/sim/mesh_frame.h"

namespace spelunk::sim {

/// A triangle mesh of a world, metres, z up. Vertices, start and all that is simulated in it are in
/// `frame`, whose caller's frame is that of the mesh file.
struct WorldMesh {
  std::string name;
  LocalFrame frame;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;            ///< Indices of vertices.
  std::optional<Pose> start;                         ///< From <name>.json or the world description.
  std::optional<AxisAlignedBox> exploration_bounds;  ///< From <name>.json.
  [[nodiscard]] AxisAlignedBox bounds() const;
};

/// What decides in which frame a mesh is held: see LocalFrame::around().
struct Surroundings {
  std::optional<Eigen::Vector3d> start;  ///< World frame; none: the mesh's own start.
  double reach_m = 0.0;
  double range_m = std::numeric_limits<double>::infinity();
};

/// Reads a .dae/.stl/.obj/.ply file; a Collada file's unit and up-axis are honoured, then what is
/// `told`, else what `<name>.json` beside it says ("scale", "up"). Its "start" and "bounds" are in
/// the world frame. Triangles without area and those that are there twice are left out. Says in the
/// log what was read, what looks like another unit or up-axis, and whether the numbers of the file
/// are coarser than a millimetre. Throws OutsideError with path and remedy if a file is missing or
/// unreadable, holds no triangles or numbers that are not finite.
[[nodiscard]] WorldMesh loadWorldMesh(const std::string& path, const MeshFrame& told = {},
                                      const Surroundings& around = {});

/// Writes binary STL. Throws OutsideError.
void saveStl(const WorldMesh& mesh, const std::string& path);

/// Where generated worlds are kept: $SPELUNK_CACHE, else spelunk in $XDG_CACHE_HOME, in ~/.cache
/// or, without a home, in the folder for temporary files.
[[nodiscard]] std::string defaultCacheDir();

/// A name from `worlds_dir` (worlds/<name>.yaml, generated on first use and cached in `cache_dir`,
/// an unwritable cache being no fault) or the path of a mesh file, for which `told` is meant.
/// Throws OutsideError that lists the known names.
[[nodiscard]] WorldMesh openWorld(const std::string& name_or_path, const std::string& worlds_dir,
                                  const std::string& cache_dir, const MeshFrame& told = {},
                                  const Surroundings& around = {});

}  // namespace spelunk::sim
