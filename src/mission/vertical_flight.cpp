#include "spelunk/mission/vertical_flight.h"

#include <cmath>

namespace spelunk::mission {
namespace {

/// A shorter climb is not worth a motion of its own.
constexpr double kShortestClimb_m = 0.1;
/// The controller holds that close; less would call a robot that hovers over its stand away from
/// it.
constexpr double kOnStand_m = 0.15;

}  // namespace

/// For the body alone, and beginning a voxel above the lower end: there the ground may be touched.
bool VerticalFlight::isColumnFree(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
  const Eigen::Vector3d from = low + Eigen::Vector3d(0.0, 0.0, basis_.space.resolution());
  if (from.z() >= high.z()) return true;
  return basis_.space.of(basis_.space.bodyBox()).isSweepFree(from, high);
}

bool VerticalFlight::isNeeded() const {
  const Eigen::Vector3d& here = basis_.watch.pose().position;
  const Eigen::Vector3d& box = basis_.robot.box_m;
  if (basis_.space.of(box).isFree(here)) return false;
  // What is beside the robot is still there higher up: only what is below it is left by a climb.
  const Eigen::Vector3d lid(box.x(), box.y(), basis_.space.resolution());
  const Eigen::Vector3d above = here + Eigen::Vector3d(0.0, 0.0, 0.5 * box.z());
  return basis_.space.of(lid).isFree(above) && findClimb().has_value();
}

std::optional<Leg> VerticalFlight::findClimb() const {
  if (kindOf(basis_.robot) != RobotKind::kAerial) return std::nullopt;
  const Pose& here = basis_.watch.pose();
  map::ConfigurationSpace& whole = basis_.space.of(basis_.robot.box_m);
  const double low_z = stand_ ? stand_->position.z() : here.position.z();
  const double step_m = 0.5 * basis_.space.resolution();
  for (double z = low_z + basis_.robot.take_off_height_m; z > here.position.z() + kShortestClimb_m;
       z -= step_m) {
    Pose top = here;
    top.position.z() = z;
    if (!whole.isFree(top.position) || !isColumnFree(here.position, top.position)) continue;
    return Leg({here, top}, planners::PathKind::kLocal, basis_.space.bodyBox());
  }
  return std::nullopt;
}

std::optional<Leg> VerticalFlight::findLanding() const {
  const Pose& here = basis_.watch.pose();
  Pose above = here;
  above.position.head<2>() = stand_->position.head<2>();
  const Pose down{stand_->position, here.yaw};
  if (!isColumnFree(down.position, above.position) ||
      !basis_.space.isTrailClear({here, above}, basis_.space.bodyBox()))
    return std::nullopt;
  Path path{here};
  if (distance(here, above) > kOnStand_m) path.push_back(above);
  path.push_back(down);
  return Leg(path, planners::PathKind::kHome, basis_.space.bodyBox());
}

bool VerticalFlight::hasLanded() const {
  const Pose& here = basis_.watch.pose();
  return std::fabs(here.position.z() - stand_->position.z()) <= kOnStand_m;
}

}  // namespace spelunk::mission
