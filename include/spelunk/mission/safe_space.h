#pragma once

#include <Eigen/Core>
#include <deque>

#include "spelunk/common/path.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/map/configuration_space.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/mission/home_graph.h"
#include "spelunk/mission/zones.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/navigation/trajectory_timing.h"

namespace spelunk::mission {

/// Occupied voxels that a body touches.
struct Contact {
  int voxels = 0;
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();  ///< Of their centres; if there are any.
};

/// What the robot may move through: the map as it is now, the zones, and the ground under a robot
/// with legs. Paths are those of the centre of the robot's box.
class SafeSpace {
 public:
  SafeSpace(const map::MapParams& map_params, const RobotModel& robot);

  [[nodiscard]] map::OccupancyMap& map() { return map_; }
  [[nodiscard]] Zones& zones() { return zones_; }
  [[nodiscard]] const Zones& zones() const { return zones_; }
  [[nodiscard]] double resolution() const { return map_.params().resolution_m; }
  /// The robot's own body: returns from there are the robot itself. Full extents, metres.
  [[nodiscard]] Eigen::Vector3d bodyBox() const;

  /// The configuration space of a box in the map as it is now.
  [[nodiscard]] map::ConfigurationSpace& of(const Eigen::Vector3d& box,
                                            map::Passable passable = map::Passable::kKnownFree);

  /// A path out of the robot's present place, with the full safety box; where the robot's margin
  /// already touches something, its first short step out of there with the body alone.
  [[nodiscard]] navigation::PathCheck checkProposal(const Path& path);
  /// The same for a way home, with a box of its own; marked ground has been walked on.
  [[nodiscard]] navigation::PathCheck checkLeavingForHome(const Path& path,
                                                          const Eigen::Vector3d& box);
  /// Whether a box can be moved along a path outside all zones.
  [[nodiscard]] bool isClear(const Path& path, const Eigen::Vector3d& box);
  /// The same for the robot's own trail, where marked ground has been walked on.
  [[nodiscard]] bool isTrailClear(const Path& path, const Eigen::Vector3d& box) {
    return checkTrail(path, box).isFree();
  }
  [[nodiscard]] navigation::PathCheck checkTrail(const Path& path, const Eigen::Vector3d& box);

  /// Where along a path something is so near that the robot has to be slow: within the room that
  /// its body needs to tilt at full speed, or within the margin of its box.
  [[nodiscard]] std::vector<navigation::SlowPiece> narrowPieces(const Path& path);
  /// The path with the room to tilt above and below it, where there is such room a little higher or
  /// lower: the first waypoint stays, the last one too if `end` says so. Whatever cannot be moved
  /// safely stays as it is.
  enum class PathEnd { kStays, kMoves };
  [[nodiscard]] Path withHeadroom(const Path& path, PathEnd end);

  /// Asks whether legs find footing between two places; empty for robots that fly.
  [[nodiscard]] HomeGraph::Footing footing() const;
  /// Whether legs find footing along a path; always for robots that fly.
  [[nodiscard]] bool isWalkable(const Path& path);
  /// What occupied voxels the robot's body touches.
  [[nodiscard]] Contact contactAt(const Eigen::Vector3d& centre);

 private:
  [[nodiscard]] map::ConfigurationSpace& roomy();
  [[nodiscard]] navigation::PathCheck checkLeaving(const Path& path, const Eigen::Vector3d& box,
                                                   const std::vector<NoGoZone>& zones,
                                                   const AxisAlignedBox& bounds);

  RobotModel robot_;
  map::OccupancyMap map_;
  Zones zones_;
  std::deque<map::ConfigurationSpace> spaces_;  ///< One a box that was asked for.
};

}  // namespace spelunk::mission
