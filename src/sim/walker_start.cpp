#include "spelunk/sim/walker_start.h"

#include <cmath>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/start_check.h"
#include "spelunk/sim/trunk_posture.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

constexpr double kDrop_m = 1.5;       ///< The ground is looked for so far below the start.
constexpr double kRise_m = 0.5;       ///< Feet may stand so far above the ground in the middle.
constexpr double kSlopeMax_deg = 30;  ///< No robot is set on steeper ground.

[[noreturn]] void refuse(const Pose& start, const WorldMesh& mesh, const std::string& reason) {
  throw OutsideError("start " + textOf(start.position, mesh) + " in the world '" + mesh.name +
                     "': " + reason + " (--start x,y,z,yaw)");
}

Vector3d groundUnder(const FootholdSearch& ground, const WorldMesh& mesh, const Pose& start) {
  const auto middle = ground.groundBelow(start.position, kDrop_m);
  if (!middle)
    refuse(start, mesh,
           "no ground within 1.5 m below; choose a start on a floor that the robot can stand on");
  return middle->position;
}

/// The ground under the hips of an upright robot.
FootPoints underTheHips(const FootholdSearch& ground, const WorldMesh& mesh,
                        const WalkerParams& params, const Pose& start, const Vector3d& middle) {
  const Eigen::AngleAxisd turn(start.yaw, Vector3d::UnitZ());
  FootPoints points;
  for (std::size_t k = 0; k < kLegs; ++k) {
    Vector3d above = middle + turn * Leg(params, k).root();
    above.z() = std::max(start.position.z(), middle.z() + kRise_m);
    const auto foot = ground.groundBelow(above, above.z() - middle.z() + kRise_m);
    if (!foot)
      refuse(
          start, mesh,
          std::string("no ground under foot ") + kLegNames[k] + "; choose a start on firm floor");
    points[k] = foot->position;
  }
  return points;
}

}  // namespace

Stance standBelow(const MeshScene& scene, const WorldMesh& mesh, const WalkerParams& params,
                  const Pose& start) {
  const FootholdSearch ground(scene, params);
  const Vector3d middle = groundUnder(ground, mesh, start);
  const GroundPlane plane = planeThrough(underTheHips(ground, mesh, params, start, middle));
  if (const double slope = std::atan(plane.slope.norm()) * 180.0 / M_PI; slope > kSlopeMax_deg) {
    std::ostringstream text;
    text << "the ground rises by " << slope << " degrees, the limit is " << kSlopeMax_deg
         << "; choose a start on flatter ground";
    refuse(start, mesh, text.str());
  }
  Stance stance;
  stance.position = middle;
  stance.position.z() = plane.heightAt(middle.head<2>()) + params.stand_height_m;
  stance.orientation = orientationOn(plane.normal(), start.yaw);
  const Vector3d extents =
      stance.orientation.toRotationMatrix().cwiseAbs() * params.trunk_m;  // of the tilted trunk
  requireFreeBody(scene, mesh, stance.position, extents, "walker.trunk_m");
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
  T_world_base.translate(stance.position);
  T_world_base.rotate(stance.orientation);
  for (std::size_t k = 0; k < kLegs; ++k) {
    const Leg leg(params, k);
    const auto hold = ground.find(leg, T_world_base, T_world_base * leg.root());
    if (!hold)
      refuse(
          start, mesh,
          std::string("foot ") + kLegNames[k] + " finds no place to stand; choose a flatter one");
    stance.holds[k] = *hold;
  }
  return stance;
}

}  // namespace spelunk::sim
