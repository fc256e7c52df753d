#include "spelunk/sim/start_check.h"

#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/mesh_size.h"

namespace spelunk::sim {

std::string textOf(const Eigen::Vector3d& position) {
  std::ostringstream text;
  text << "(" << position.x() << ", " << position.y() << ", " << position.z() << ")";
  return text.str();
}

void requireInside(const WorldMesh& mesh, const Pose& start) {
  if (!isFinite(start)) throw OutsideError("start pose is not finite; give numbers x,y,z,yaw");
  if (!mesh.bounds().contains(start.position))
    throw OutsideError("start " + textOf(start.position) + " lies outside the world '" + mesh.name +
                       "', which is " + boundsText(mesh.bounds()) + sizeAdvice(mesh.bounds()) +
                       "; give a start inside the mesh (--start x,y,z,yaw)");
}

void requireFreeBody(const MeshScene& scene, const WorldMesh& mesh, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& size_m, const std::string& size_key) {
  if (scene.boxDistance(position, size_m, 1.0) > 0.0) return;
  std::ostringstream text;
  text << "start " << textOf(position) << " is in collision with the world '" << mesh.name
       << "': clearance " << scene.distanceTo(position, 100.0) << " m from the centre, the body is "
       << size_m.transpose()
       << " m; choose a start farther from walls (--start x,y,z,yaw) or a smaller " << size_key;
  throw OutsideError(text.str());
}

}  // namespace spelunk::sim
