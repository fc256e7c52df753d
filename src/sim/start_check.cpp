#include "spelunk/sim/start_check.h"

#include <cmath>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/mesh_size.h"

namespace spelunk::sim {

std::string textOf(const Eigen::Vector3d& position) {
  std::ostringstream text;
  text.precision(10);  // millimetres of a UTM northing
  for (int k = 0; k < 3; ++k)
    text << (k == 0 ? "(" : ", ") << std::round(1000.0 * position(k)) / 1000.0 + 0.0;
  return text.str() + ")";
}

std::string textOf(const Eigen::Vector3d& position, const WorldMesh& mesh) {
  return textOf(mesh.frame.toCaller(position));
}

void requireInside(const WorldMesh& mesh, const Pose& start) {
  if (!isFinite(start)) throw OutsideError("start pose is not finite; give numbers x,y,z,yaw");
  if (!mesh.bounds().contains(start.position))
    throw OutsideError("start " + textOf(start.position, mesh) + " lies outside the world '" +
                       mesh.name + "', which is " + boundsText(mesh.frame.toCaller(mesh.bounds())) +
                       sizeAdvice(mesh.bounds()) +
                       "; give a start inside the mesh (--start x,y,z,yaw)");
}

void requireFreeBody(const MeshScene& scene, const WorldMesh& mesh, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& size_m, const std::string& size_key) {
  if (scene.boxDistance(position, size_m, 1.0) > 0.0) return;
  std::ostringstream text;
  text << "start " << textOf(position, mesh) << " is in collision with the world '" << mesh.name
       << "': clearance " << scene.distanceTo(position, 100.0) << " m from the centre, the body is "
       << size_m.transpose()
       << " m; choose a start farther from walls (--start x,y,z,yaw) or a smaller " << size_key;
  throw OutsideError(text.str());
}

}  // namespace spelunk::sim
