#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/evaluation/explored_volume.h"
#include "spelunk/evaluation/promise_watch.h"
#include "spelunk/evaluation/reachable_volume.h"
#include "spelunk/mission/mission.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/sim/simulator.h"

namespace spelunk::evaluation {

/// One simulated second of a mission.
struct TimelineRow {
  double t_s = 0.0;
  double explored_m3 = 0.0;  ///< Within the reachable space.
  double distance_m = 0.0;   ///< True path length flown.
  Pose pose;                 ///< True.
  double remaining_s = 0.0;
  mission::MissionState state = mission::MissionState::kIdle;
  double clearance_m = 0.0;  ///< Of the robot's body to the mesh, at most 5.
};

/// One plan and what became of it at the mission's own check.
struct PlanRow {
  double t_s = 0.0;
  bool explore = true;
  planners::PlanResult result;  ///< Path left out.
  double length_m = 0.0;
  double wall_ms = 0.0;  ///< Plan and way home together.
  std::string verdict;   ///< "accepted" or the mission's reason.
};

/// A point the robot is sent to, and how it is to find its way there.
struct GoToLeg {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  navigation::NavigationParams navigation;
};

/// What became of one such leg.
struct GoToRecord {
  GoToLeg leg;
  mission::GoToStatus status;
  double path_length_m = 0.0;  ///< True path flown.
  double execution_s = 0.0;    ///< From its begin to its end, plans included as they take no time.
  double final_distance_m = 0.0;  ///< To the target, true.
};

/// What a whole mission brought.
struct RunRecord {
  std::string outcome;  ///< Why it ended.
  bool returned_home = false;
  bool ended_as_it_may =
      false;  ///< Home with endurance left and without a collision being its end.
  double mission_time_s = 0.0;
  double wall_time_s = 0.0;
  double explored_volume_m3 = 0.0;   ///< Within the reachable space.
  double explored_outside_m3 = 0.0;  ///< Seen beyond it, through cracks and holes of the mesh.
  ReachableVolume reachable;
  double path_length_m = 0.0;
  int collisions = 0;
  double collision_s = 0.0;
  double min_clearance_m = 0.0;  ///< Of the robot's body to the mesh.
  int falls = 0;
  int slips = 0;
  int trips = 0;
  int zones_marked = 0;
  PromiseRecord promise;
  double remaining_at_home_s = 0.0;
  std::vector<TimelineRow> timeline;
  std::vector<PlanRow> plans;
  std::vector<GoToRecord> legs;  ///< Empty for a mission that explored.
  std::vector<double> map_update_ms;
  std::vector<planners::RemainingTarget> remaining_targets;
};

/// What a progress line shows.
struct Progress {
  double t_s = 0.0;
  double explored_m3 = 0.0;
  double rate_m3ps = 0.0;  ///< Over the last ten seconds.
  mission::MissionStatus status;
};

/// How late things are and what gets lost between robot and mission, as over a network or on a busy
/// computer (section "delays").
struct Delays {
  double plan_s = 0.0;
  double scan_s = 0.0;
  double scan_loss = 0.0;
  double odometry_period_s = 0.0;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("plan_s", plan_s, Bounds{0.0, 60.0}, "a plan takes so long, simulated time");
    field("scan_s", scan_s, Bounds{0.0, 10.0}, "a scan enters the map so late");
    field("scan_loss", scan_loss, Bounds{0.0, 1.0}, "share of scans that never arrive");
    field("odometry_period_s", odometry_period_s, Bounds{0.0, 10.0},
          "between two odometry messages; 0: at every tick");
  }
};

/// What a run is made of.
struct RunSetup {
  RobotModel robot;
  sim::SimParams sim;
  map::MapParams map;
  mission::MissionParams mission;
  terrain::TerrainParams terrain;
  Pose start;
  /// Of exploration. A robot with a sensor that reports misses stays within the mesh besides.
  AxisAlignedBox bounds;
  std::vector<NoGoZone> zones;
  std::uint64_t seed = 1;
  double time_limit_s = 900.0;  ///< Endurance by time; the battery may say less.
  Delays delays;
  std::vector<GoToLeg> legs;  ///< If there are some: fly to them, one after the other, and end.
};

/// A whole mission in lockstep: simulator, mission and planner advance by tenths of a second of
/// simulated time, plans take no simulated time beyond the mission's own look-ahead unless
/// `delays` says so. The same setup gives the same record, wall times aside.
class MissionRun {
 public:
  /// Throws OutsideError if the start is in collision, or as reachableSpace() does. `mesh` and
  /// `planner` must outlive the run.
  MissionRun(const RunSetup& setup, const sim::WorldMesh& mesh,
             planners::ExplorationPlanner& planner);
  ~MissionRun();

  /// Flies until the mission is done (or the last leg reached, or one not), out of endurance, or
  /// has held at one place for good. Calls `show` about every simulated second if given.
  [[nodiscard]] RunRecord fly(const std::function<void(const Progress&)>& show = {});

  /// Ends the flight before its next tenth of a second, for a reason that the record names. Call it
  /// from `show`.
  void stop(const std::string& why);
  /// What there is to explore, and whether the mesh leaks; known before the flight.
  [[nodiscard]] ReachableVolume reachable() const;

  /// The mission, for its map and trail after the flight.
  [[nodiscard]] mission::Mission& mission();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::evaluation
