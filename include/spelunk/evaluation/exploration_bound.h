#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "spelunk/common/pose.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/evaluation/reachable_volume.h"
#include "spelunk/sim/world_mesh.h"

namespace spelunk::evaluation {

/// How finely the bound looks. Finer is tighter and costs more.
struct BoundParams {
  double cell_m = 2.0;    ///< Edge of a cell of positions.
  double target_m = 1.0;  ///< Edge of a voxel that is seen or not.
  double grid_m = 0.5;    ///< Voxels of lines of sight and of travel distances.
  /// Where there is more to see than this, all edges grow with the cube root of the ratio: the cost
  /// of the bound grows with the square of the volume.
  double volume_m3 = 40000.0;
};

/// An upper bound on the part of the reachable volume (reachable_volume.h) that any planner can
/// have explored after t seconds, if the robot flies no faster than its speed and is home by the
/// time limit. It is the smallest of three bounds, each of which holds by itself:
///
/// 1. *There is no more*: the reachable volume.
///
/// 2. *It must get there*: a path of length L, looked at every 3 m, is a chain of at most
///    ceil(L / 3) links; a breadth-first search over voxels whose links join any two voxels that
///    hold points at most 3 m apart therefore needs no more links, and L > 3 (links - 1). At time s
///    the robot is within speed * s of the start and, being home at T, within speed * (T - s) of
///    it: only cells within speed * min(t, T / 2) count. What none of them sees is not explored.
///
/// 3. *It cannot be everywhere*: a path of length speed * t is N = ceil(speed * t / l) pieces of
///    length l. All of a piece lies within l / 2 of its middle; looked at every `cell_m`, the way
///    from the middle steps from a cell to itself or one of its 26 neighbours, so with
///    l = 2 h cell_m the piece lies in the cells at most h such steps through cells with reachable
///    space from the middle's. Let P(c) hold all that is seen from those, and f(X) be the volume of
///    the union of P over X. f is submodular, so for any set A of cells
///    f(path) <= f(A) + (sum of the N largest f(A + c) - f(A)) (Nemhauser, Wolsey and Fisher, An
///    analysis of approximations for maximizing submodular set functions, Mathematical Programming
///    14, 1978). The smallest right side over greedy sets A of several sizes and several h is
///    taken.
///
/// What is seen from a cell is a superset of the truth: if p sees q, p no farther than r from the
/// cell's centre and q no farther than r from its voxel's centre, the line between the two centres
/// stays within r of the line of sight, so it runs through free space grown by r. Lines of sight
/// are walked through that grown space; the field of view is not used, range and the sensor's
/// mount are.
class ExplorationBound {
 public:
  /// Throws OutsideError as reachableVolume() does.
  ExplorationBound(const sim::WorldMesh& mesh, const Pose& start, const RobotModel& robot,
                   const BoundParams& params = {});
  ~ExplorationBound();

  /// Where the mesh leaks, if it does: then the bound is one on what lies outside, too.
  [[nodiscard]] std::optional<Leak> leak() const;

  /// Cubic metres at every whole second from 0 to the limit; never falling.
  [[nodiscard]] std::vector<double> over(double time_limit_s) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::evaluation
