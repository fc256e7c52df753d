#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/local_frame.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/mission/answer.h"
#include "spelunk/mission/command.h"
#include "spelunk/mission/input_notes.h"
#include "spelunk/mission/mission_params.h"
#include "spelunk/mission/mission_status.h"
#include "spelunk/mission/plan_job.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/terrain/terrain_map.h"

namespace spelunk::mission {

/// The mission: keeps the map, the state machine, the trail and the endurance guard. It asks for
/// plans by handing out jobs, checks each result by itself and says what the robot is to do.
///
/// Invariant (design, section 4): at every moment there is a known collision-free path home whose
/// pessimistic travel time fits the remaining endurance; a path is accepted only if that still
/// holds at its end.
///
/// Robots with legs: while walking, the ground ahead is checked in the terrain map again and again;
/// where it is untraversable the robot stops, goes back half a metre, marks the place as a no-go
/// zone for good and plans anew (Dang 2020, section 4.3). Poses that go to planners and into maps
/// are those of the centre of the robot's box, box_lift_m above its base.
///
/// No threads, no clock, no ROS inside: the owner calls from one thread at a time.
class Mission {
 public:
  Mission(const MissionParams& params, const RobotModel& robot, const map::MapParams& map_params,
          std::uint64_t seed, const terrain::TerrainParams& terrain = {});
  ~Mission();
  Mission(Mission&&) noexcept;
  Mission& operator=(Mission&&) noexcept;

  // --- What the robot reports. Odd input is refused with a throttled message, never thrown.
  void onOdometry(const RobotState& state);
  map::MapUpdate onScan(const Scan& scan);  ///< Into the map; re-checks path and way home.
  void onRemaining(double remaining_s);     ///< From the battery; else the time budget counts.

  /// What the owner knows about inputs that the mission cannot see; replaces what it said before.
  void noteInputs(const InputNotes& notes);

  /// The frame of odometry was corrected: the command of now in it, to be sent again (see
  /// MissionFrame); none if nothing was commanded yet.
  [[nodiscard]] std::optional<Command> commandAgain(double now_s) const;

  // --- What people ask for.
  Answer start();
  Answer pause();
  Answer home();
  Answer emergencyStop();
  Answer setBounds(const AxisAlignedBox& bounds);
  Answer setZones(std::vector<NoGoZone> zones);

  /// Whether the robot may be sent to a point now, as far as that can be told without a plan: it
  /// stands ready, and even the straight way there and home fits the endurance.
  [[nodiscard]] Answer mayGoTo(const Eigen::Vector3d& point);
  /// Flies to a point (world frame, where the robot's base is to be); only if mayGoTo(). The way is
  /// planned by jobs, the first one like all others: takeJob() hands it out at once. Only what lies
  /// in known free space is flown, checked like any other path, way home included. More of the path
  /// is taken up as it comes into view; where the path turns out blocked, or the robot has left it,
  /// the mission stops and asks for a new one. Holds at the end, and where no way is found; see
  /// MissionStatus::go_to. `time_limit_s`: wall time of one plan, for flight only.
  Answer goTo(const Eigen::Vector3d& point, const navigation::NavigationParams& params,
              double time_limit_s = std::numeric_limits<double>::infinity());
  /// A plan's request from where the robot is, for plans that are only looked at; none before the
  /// first good odometry.
  [[nodiscard]] std::optional<planners::PlanRequest> requestHere(double now_s);

  // --- The cycle, about 10 Hz.
  /// Advances the state machine to `now_s`; returns a new command if there is one.
  std::optional<Command> tick(double now_s);
  /// A plan that is wanted now, at most one at a time; pass its outcome to `accept`.
  [[nodiscard]] std::optional<PlanJob> takeJob();
  /// Checks an outcome and, if it holds, returns the new command.
  std::optional<Command> accept(const PlanOutcome& outcome, double now_s);
  /// The same; the next tick returns the command.
  void take(const PlanOutcome& outcome, double now_s);

  // --- What there is to see.
  [[nodiscard]] MissionStatus status() const;
  /// Whether the robot moves or will move by itself: also while it holds to plan anew.
  [[nodiscard]] bool isRunning() const;
  // Paths are those of the robot's base.
  [[nodiscard]] Path activePath() const;
  /// The newest plan of a flight to a point, its trees included; none while there is no such
  /// flight.
  [[nodiscard]] std::optional<navigation::NavigationAnswer> goToPlan() const;
  [[nodiscard]] Path wayHome() const;  ///< From about here; the best that is known.
  [[nodiscard]] Path trail() const;
  [[nodiscard]] const AxisAlignedBox& bounds() const;
  [[nodiscard]] const std::vector<NoGoZone>& zones() const;
  [[nodiscard]] const std::vector<planners::RemainingTarget>& remaining() const;
  [[nodiscard]] map::OccupancyMap& map();
  [[nodiscard]] const RobotModel& robot() const;
  /// The ground around a robot with legs; nullptr for others.
  [[nodiscard]] std::shared_ptr<const terrain::TerrainView> terrain();

  /// Saves map.bt/.ot, trail, budget, bounds and zones into a folder (with `graph` if given); load
  /// takes them up again: zones that the robot marked stay apart from those that people set. The
  /// text of the Answer names path and reason. `frame`: in which this mission works; the record is
  /// written in the caller's, and loaded in the frame that it was saved with.
  Answer save(const std::string& folder, const planners::PlannerGraph& graph,
              const LocalFrame& frame = {});
  Answer load(const std::string& folder, planners::PlannerGraph* graph);

 private:
  friend struct MissionProbe;  // of the tests: looks at every part
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::mission
