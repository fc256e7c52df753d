#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/map/occupancy_map.h"
#include "spelunk/mission/way_home_search.h"
#include "spelunk/navigation/navigator.h"
#include "spelunk/planners/exploration_planner.h"
#include "spelunk/terrain/terrain_map.h"

namespace spelunk::mission {

enum class MissionState { kIdle, kExplore, kReposition, kHome, kHold, kDone, kEStop };
[[nodiscard]] const char* toText(MissionState state);  ///< "Idle", "Explore", ...

/// Parameters of the mission (section "mission").
struct MissionParams {
  double reserve_s = 20.0;
  double reserve_percent = 3.0;
  double pessimism = 1.15;    ///< Travel times are taken this much longer.
  double plan_ahead_s = 1.5;  ///< A new path takes over this long after it was asked for.
  double deviation_max_m = 0.8;
  bool verify_ground = true;  ///< Legged robots only.
  double home_radius_m = 1.0;
  double replan_period_s = 2.0;    ///< Local paths are renewed this often while they are flown.
  double start_clearance_m = 1.0;  ///< Unknown space so near around the start counts as free.
  int max_samples = 10000;

  template <class Visitor>
  void visit(Visitor&& field) {
    field("reserve_s", reserve_s, Bounds{0.0, 1e5}, "endurance that must be left at home",
          Audience::kUser);
    field("reserve_percent", reserve_percent, Bounds{0.0, 90.0}, "the same, of the full endurance",
          Audience::kUser);
    field("pessimism", pessimism, Bounds{1.0, 5.0}, "factor on every travel time home");
    field("plan_ahead_s", plan_ahead_s, Bounds{0.0, 30.0}, "the next path starts this far ahead");
    field("deviation_max_m", deviation_max_m, Bounds{0.05, 10.0},
          "farther from the path: hold and replan");
    field("verify_ground", verify_ground, Bounds{},
          "look at the ground ahead while walking (legged)");
    field("home_radius_m", home_radius_m, Bounds{0.1, 10.0}, "nearer counts as home");
    field("replan_period_s", replan_period_s, Bounds{0.2, 1000.0},
          "a local path is renewed so often");
    field("start_clearance_m", start_clearance_m, Bounds{0.0, 5.0},
          "unknown space around the start taken as free");
    field("max_samples", max_samples, Bounds{10, 10000000}, "samples tried by one plan");
  }
};

/// The answer to a request from outside.
struct Answer {
  bool accepted = false;
  std::string reason;
};

/// What the robot is to do now; replaces what it did before.
struct Command {
  Path path;              ///< Empty: stop and hold.
  Trajectory trajectory;  ///< The same path timed; empty with it.
  planners::PathKind kind = planners::PathKind::kLocal;
};

/// A path to a point that was asked for, to be planned by navigation.
struct NavigationJob {
  navigation::NavigationParams params;
  navigation::NavigationQuery query;
};

/// A plan to be computed, on data that nobody changes: run it in any thread, or at once.
struct PlanJob {
  planners::PlanRequest request;
  bool explore = true;                 ///< false: only the way home is asked for.
  std::optional<NavigationJob> go_to;  ///< If set, nothing else is asked for.
  /// If set, the way home is looked for by navigation and the planner is not asked.
  std::optional<WayHomeSearch> way_home;
  std::uint64_t number = 0;
};

/// What a job brought: the plan, and the way home from its end (or from the start if there is
/// none); or navigation's answer.
struct PlanOutcome {
  std::uint64_t number = 0;
  planners::PlanResult plan;
  planners::PlanResult home;
  navigation::NavigationAnswer go_to;
};

[[nodiscard]] PlanOutcome run(const PlanJob& job, planners::ExplorationPlanner& planner);

enum class GoToOutcome { kNone, kUnderway, kReached, kUnreachable, kAborted };
[[nodiscard]] const char* toText(GoToOutcome outcome);  ///< "none", "underway", "reached", ...

/// The flight to a point that was asked for. A replan is a new plan because the path in execution
/// cannot be flown on; taking up more of the same path as it comes into view is not counted.
struct GoToStatus {
  GoToOutcome outcome = GoToOutcome::kNone;
  std::string reason;  ///< Of its end; one sentence.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> nearest_reachable;  ///< Only with kUnreachable, where known.
  int replans_obstacle = 0;   ///< A newly seen obstacle lies on the path, anywhere ahead.
  int replans_deviation = 0;  ///< The robot left the path, or its inputs failed meanwhile.
  int replans_unseen = 0;     ///< What comes next on the path cannot be seen from its known end.
  double planning_s = 0.0;    ///< Wall time of all plans, the first one included.
  double started_s = 0.0;     ///< Mission time.
  double ended_s = 0.0;
};

/// Everything a status line needs.
struct MissionStatus {
  double time_s = 0.0;
  MissionState state = MissionState::kIdle;
  std::string reason;  ///< Of the newest change or refusal, one sentence.
  std::string last_plan_status;
  std::string end_reason;  ///< Why the mission ended; empty before.
  double known_volume_m3 = 0.0;
  double remaining_s = 0.0;
  double way_home_s = 0.0;  ///< Pessimistic.
  double margin_s = 0.0;    ///< remaining - reserve - way home.
  double distance_m = 0.0;
  int plans = 0;
  int replans_obstacle = 0;
  int replans_deviation = 0;
  int refused_paths = 0;
  int zones_marked = 0;  ///< No-go zones made around untraversable ground.
  GoToStatus go_to;
  planners::PlanStats last_stats;
  double last_map_update_ms = 0.0;
};

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

  // --- What the robot reports. Odd input is refused with a throttled message, never thrown.
  void onOdometry(const RobotState& state);
  map::MapUpdate onScan(const Scan& scan);  ///< Into the map; re-checks path and way home.
  void onRemaining(double remaining_s);     ///< From the battery; else the time budget counts.

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
  /// What navigation is to be asked for a way from here to a point (world frame, where the robot's
  /// base is to be); none before the first good odometry. What a robot at its start stands in
  /// counts as free from then on. The caller sets `rng`.
  [[nodiscard]] std::optional<navigation::NavigationQuery> goToQuery(const Eigen::Vector3d& point);
  /// Flies to the goal of a query, beginning with the path it was answered by; only if mayGoTo()
  /// and only if the answer holds a path. Only what lies in known free space is flown, checked like
  /// any other path, way home included. More of the path is taken up as it comes into view; where
  /// the path turns out blocked, or the robot has left it, the mission stops and asks for a new one
  /// by a job. Holds at the end; see MissionStatus::go_to.
  Answer goTo(const navigation::NavigationParams& params, const navigation::NavigationQuery& query,
              const navigation::NavigationAnswer& answer);
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

  // --- What there is to see.
  [[nodiscard]] MissionStatus status() const;
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
  /// text of the Answer names path and reason.
  Answer save(const std::string& folder, const planners::PlannerGraph& graph);
  Answer load(const std::string& folder, planners::PlannerGraph* graph);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spelunk::mission
