#include "spelunk/sim/mesh_frame.h"

#include <cmath>

#include "spelunk/common/contract.h"

namespace spelunk::sim {

MeshFrame MeshFrame::elseOf(const MeshFrame& there) const {
  return {scale ? scale : there.scale, up ? up : there.up};
}

Eigen::Matrix3d MeshFrame::T_world_file() const {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (up == UpAxis::kY) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == UpAxis::kX) turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return scale.value_or(1.0) * turn;
}

std::optional<UpAxis> upAxisOf(const std::string& text) {
  if (text == "x" || text == "X") return UpAxis::kX;
  if (text == "y" || text == "Y") return UpAxis::kY;
  if (text == "z" || text == "Z") return UpAxis::kZ;
  return std::nullopt;
}

MeshFrame meshFrameOf(double scale, const std::string& up, const MeshFrameKeys& keys) {
  MeshFrame frame;
  if (scale != 0.0) {
    if (!std::isfinite(scale) || scale < 0.0)
      throw OutsideError(keys.scale + " " + std::to_string(scale) +
                         ": give the metres a unit of the mesh, 0.001 for millimetres");
    frame.scale = scale;
  }
  if (!up.empty()) {
    frame.up = upAxisOf(up);
    if (!frame.up)
      throw OutsideError(keys.up + " '" + up +
                         "': give the axis of the mesh that points up: x, y or z");
  }
  return frame;
}

}  // namespace spelunk::sim
