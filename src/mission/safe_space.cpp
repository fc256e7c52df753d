#include "spelunk/mission/safe_space.h"

#include <algorithm>

#include "spelunk/terrain/ground_rules.h"

namespace spelunk::mission {
namespace {

/// A step out of a place whose margin is lost: longer ones are no step but a flight without margin.
constexpr double kStepOut_m = 0.7;

constexpr double kNarrowStep_m = 0.5;    // half a body
constexpr double kHeadroomStep_m = 1.0;  // between places whose height may change
constexpr int kHeightTries = 3;          // on each side, up to the room itself and some more

/// The height nearest to that of `place` at which `room` is free; its own where there is none.
double heightWithRoom(map::ConfigurationSpace& room, const Eigen::Vector3d& place,
                      double tilt_room_m) {
  if (room.isFree(place)) return place.z();
  const double step = std::max(0.5 * tilt_room_m, 0.5 * room.resolution());
  for (int k = 1; k <= kHeightTries; ++k)
    for (const double side : {1.0, -1.0}) {
      const Eigen::Vector3d other = place + Eigen::Vector3d(0.0, 0.0, side * k * step);
      if (room.isFree(other)) return other.z();
    }
  return place.z();
}

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

/// What was not seen is no reason to be slow: the sensors of a robot see little right above it.
map::ConfigurationSpace& SafeSpace::roomy() {
  const Eigen::Vector3d tilt(0.0, 0.0, 2.0 * robot_.tilt_room_m);
  return of(robot_.box_m + tilt, map::Passable::kNotOccupied);
}

std::vector<navigation::SlowPiece> SafeSpace::narrowPieces(const Path& path) {
  std::vector<navigation::SlowPiece> pieces;
  if (path.empty()) return pieces;
  map::ConfigurationSpace& space = roomy();
  const Path fine = resampled(path, kNarrowStep_m);
  double arc = 0.0;
  for (std::size_t i = 1; i < fine.size(); ++i) {
    const double next = arc + distance(fine[i - 1], fine[i]);
    if (!space.isSweepFree(fine[i - 1].position, fine[i].position)) {
      const bool goes_on = !pieces.empty() && pieces.back().to_m >= arc - kNarrowStep_m;
      if (goes_on)
        pieces.back().to_m = next;
      else
        pieces.push_back({arc, next, narrowSpeed(robot_)});
    }
    arc = next;
  }
  return pieces;
}

Path SafeSpace::withHeadroom(const Path& path, PathEnd end) {
  if (robot_.tilt_room_m <= 0.0 || path.size() < 2) return path;
  map::ConfigurationSpace& room = roomy();
  Path moved = resampled(path, kHeadroomStep_m);
  bool has_moved = false;
  const std::size_t last = moved.size() - (end == PathEnd::kMoves ? 0 : 1);
  for (std::size_t i = 1; i < last; ++i) {
    const double height = moved[i].position.z();
    moved[i].position.z() = heightWithRoom(room, moved[i].position, robot_.tilt_room_m);
    has_moved = has_moved || moved[i].position.z() != height;
  }
  if (!has_moved) return path;
  return navigation::checkPath(of(robot_.box_m), moved, zones_.all(), zones_.bounds()).isFree()
             ? moved
             : path;
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
