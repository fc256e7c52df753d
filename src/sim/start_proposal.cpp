#include "spelunk/sim/start_proposal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/common/params.h"
#include "spelunk/sim/mesh_scene.h"
#include "spelunk/sim/mesh_size.h"
#include "spelunk/sim/start_check.h"

namespace spelunk::sim {
namespace {

constexpr std::size_t kTriangles = 500;  ///< Looked at, spread over the mesh.
constexpr double kOffWall_m = 1.0;       ///< Places lie so far in front of and behind them,
constexpr double kAboveFloor_m = 1.0;    ///< then so high above the floor below.
constexpr double kRoom_m = 0.2;          ///< Kept between the box and the mesh.
constexpr double kSight_m = 1000.0;      ///< A wall farther away walls in nothing.
constexpr double kRoomy_m = 2.0;         ///< More room is no better.

struct Candidate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  int walls = -1;  ///< Of the six directions in which there is one.
  double room_m = 0.0;
};

/// Rounded to decimetres, which people can type.
Eigen::Vector3d typed(const Eigen::Vector3d& place) {
  return (10.0 * place).array().round() / 10.0;
}

Candidate candidateAt(const MeshScene& scene, const AxisAlignedBox& bounds, Eigen::Vector3d place,
                      const Eigen::Vector3d& size) {
  Candidate found;
  const auto floor = scene.castRay(place, -Eigen::Vector3d::UnitZ(), kSight_m);
  if (!floor) return found;
  place.z() += kAboveFloor_m - floor->range_m;
  place = typed(place);
  if (!bounds.contains(place)) return found;
  const double room = scene.boxDistance(place, size, kRoomy_m);
  if (room < kRoom_m) return found;
  found = {place, 0, room};
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      if (scene.castRay(place, sign * Eigen::Vector3d::Unit(axis), kSight_m)) ++found.walls;
  return found;
}

std::string typedText(const Pose& start) {
  std::ostringstream text;
  text.precision(10);
  text << start.position.x() << "," << start.position.y() << "," << start.position.z() << ",0";
  return text.str();
}

}  // namespace

std::optional<Pose> proposeStart(const WorldMesh& mesh, const Eigen::Vector3d& size_m) {
  const MeshScene scene(mesh);
  const AxisAlignedBox bounds = mesh.bounds();
  Candidate best;
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kTriangles);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])].cast<double>();
    };
    const Eigen::Vector3d middle = (corner(0) + corner(1) + corner(2)) / 3.0;
    const Eigen::Vector3d normal =
        (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    for (const double side : {-kOffWall_m, kOffWall_m}) {
      const Candidate found = candidateAt(scene, bounds, middle + side * normal, size_m);
      const bool is_better =
          found.walls > best.walls || (found.walls == best.walls && found.room_m > best.room_m);
      if (is_better) best = found;
    }
  }
  if (best.walls < 0) return std::nullopt;
  return Pose{best.position, 0.0};
}

std::string missingStartText(const WorldMesh& mesh, const Eigen::Vector3d& size_m,
                             const std::string& option) {
  const std::string head = "world '" + mesh.name + "' says no start: it is " +
                           boundsText(mesh.frame.toCaller(mesh.bounds())) +
                           sizeAdvice(mesh.bounds());
  const auto free = proposeStart(mesh, size_m);
  if (!free)
    return head + "; no place with room for the robot, " + toText(size_m) +
           " m, was found: is robot.box_m right, and the unit of the mesh? Or give " + option +
           "x,y,z,yaw or \"start\": [x, y, z, yaw] in <name>.json beside the mesh";
  const std::string start = typedText(mesh.frame.toCaller(*free));
  return head + "; as it is, a free place is " + option + start + " (or \"start\": [" + start +
         "] in <name>.json beside the mesh)";
}

Pose chooseStart(const WorldMesh& mesh, const std::optional<Pose>& told,
                 const Eigen::Vector3d& size_m, const std::string& option) {
  if (told) return mesh.frame.written(*told);
  if (mesh.start) return *mesh.start;
  throw OutsideError(missingStartText(mesh, size_m, option));
}

}  // namespace spelunk::sim
