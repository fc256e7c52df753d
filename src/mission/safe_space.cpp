#include "spelunk/mission/safe_space.h"

#include <algorithm>

#include "spelunk/terrain/ground_rules.h"

namespace spelunk::mission {
namespace {

/// A step out of a place whose margin is lost: longer ones are no step but a flight without margin.
constexpr double kStepOut_m = 0.7;

}  // namespace

SafeSpace::SafeSpace(const map::MapParams& map_params, const RobotModel& robot)
    : robot_(robot), map_(map_params), zones_(robot.box_m) {
  map_.watchSilence(robot.sensor_models, robot.box_m.z());
}

Eigen::Vector3d SafeSpace::bodyBox() const { return kBodyShare * robot_.box_m; }

map::ConfigurationSpace& SafeSpace::of(const Eigen::Vector3d& box, map::Passable passable) {
  auto found =
      std::find_if(spaces_.begin(), spaces_.end(), [&](const map::ConfigurationSpace& each) {
        return each.boxSize() == box && each.passable() == passable;
      });
  if (found == spaces_.end()) found = spaces_.emplace(spaces_.end(), box, passable);
  found->use(map_.freeze());
  return *found;
}

navigation::PathCheck SafeSpace::checkProposal(const Path& path) {
  return checkLeaving(path, robot_.box_m, zones_.all(), zones_.bounds());
}

navigation::PathCheck SafeSpace::checkLeavingForHome(const Path& path, const Eigen::Vector3d& box) {
  return checkLeaving(path, box, zones_.given(), {});
}

navigation::PathCheck SafeSpace::checkLeaving(const Path& path, const Eigen::Vector3d& box,
                                              const std::vector<NoGoZone>& zones,
                                              const AxisAlignedBox& bounds) {
  const auto check = navigation::checkPath(of(box), path, zones, bounds);
  if (check.isFree() || path.size() < 2 || distance(path[0], path[1]) > kStepOut_m) return check;
  const Path step_out(path.begin(), path.begin() + 2);
  if (!navigation::checkPath(of(bodyBox()), step_out, zones, {}).isFree()) return check;
  return navigation::checkPath(of(box), Path(path.begin() + 1, path.end()), zones, bounds);
}

bool SafeSpace::isClear(const Path& path, const Eigen::Vector3d& box) {
  return navigation::checkPath(of(box), path, zones_.all(), {}).isFree();
}

navigation::PathCheck SafeSpace::checkTrail(const Path& path, const Eigen::Vector3d& box) {
  return navigation::checkPath(of(box), path, zones_.given(), {});
}

HomeGraph::Footing SafeSpace::footing() const {
  if (kindOf(robot_) != RobotKind::kLegged) return {};
  return [rules = terrain::GroundRules::of(robot_, resolution())](
             const map::FrozenMap& view, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return terrain::footingAlong(a, b, rules, terrain::lookupIn(view)) == terrain::Footing::kGood;
  };
}

bool SafeSpace::isWalkable(const Path& path) {
  const HomeGraph::Footing has_footing = footing();
  if (!has_footing) return true;
  const auto view = map_.freeze();
  for (std::size_t i = 1; i < path.size(); ++i)
    if (!has_footing(*view, path[i - 1].position, path[i].position)) return false;
  return true;
}

Contact SafeSpace::contactAt(const Eigen::Vector3d& centre) {
  const auto view = map_.freeze();
  Contact contact;
  const Eigen::Vector3d touched =
      bodyBox() + Eigen::Vector3d::Constant(view->resolution());  // voxels at its faces
  view->forEachOccupied(boxAround(centre, touched), [&](const map::VoxelIndex& index) {
    const Eigen::Vector3d voxel = view->centreOf(index);
    const bool is_nearer = (voxel - centre).norm() < (contact.nearest - centre).norm();
    if (contact.voxels++ == 0 || is_nearer) contact.nearest = voxel;
  });
  return contact;
}

}  // namespace spelunk::mission
