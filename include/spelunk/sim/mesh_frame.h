#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace spelunk::sim {

/// An axis of a mesh file that points up in the world.
enum class UpAxis { kX, kY, kZ };

/// How the coordinates of a mesh as they are read (a Collada file's own unit and up-axis are
/// honoured before) become metres with z up. What is not said is said elsewhere, at last as 1 and
/// z.
struct MeshFrame {
  std::optional<double> scale;  ///< Metres a unit of the file.
  std::optional<UpAxis> up;

  /// What is said here, else there.
  [[nodiscard]] MeshFrame elseOf(const MeshFrame& there) const;

  /// p_world = T * p_file: scale and a rotation that turns `up` to z.
  [[nodiscard]] Eigen::Matrix3d T_world_file() const;

  [[nodiscard]] bool isSilent() const { return !scale && !up; }
};

/// "x", "y" or "z"; none if it is anything else.
[[nodiscard]] std::optional<UpAxis> upAxisOf(const std::string& text);

/// What a person gave as scale (0: nothing) and as axis (empty: nothing), by the names of `keys`.
/// Throws OutsideError with the remedy.
struct MeshFrameKeys {
  std::string scale = "--world-scale";
  std::string up = "--world-up";
};
[[nodiscard]] MeshFrame meshFrameOf(double scale, const std::string& up,
                                    const MeshFrameKeys& keys = {});

}  // namespace spelunk::sim
