#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spelunk/common/log.h"
#include "spelunk/common/rng.h"
#include "spelunk/mission/endurance_guard.h"
#include "spelunk/mission/home_graph.h"
#include "spelunk/mission/input_guard.h"
#include "spelunk/mission/mission.h"
#include "spelunk/mission/mission_store.h"
#include "spelunk/mission/path_execution.h"
#include "spelunk/navigation/swept_path_check.h"
#include "spelunk/navigation/trajectory_timing.h"
#include "spelunk/terrain/ground_rules.h"
#include "spelunk/terrain/terrain_map.h"

namespace spelunk::mission {

/// What the mission is about at the moment; the state says what it does for it.
enum class Goal { kNone, kExplore, kHome, kGoTo };

/// A plan that was handed out.
struct RunningJob {
  std::uint64_t number = 0;
  bool explore = true;
  bool is_second_look = false;  ///< On the way home: is something affordable again?
  bool from_standstill = false;
  bool by_navigation = false;  ///< The mission's own search for a way home, not the planner's.
  double asked_s = 0.0;
  double takes_over_s = 0.0;  ///< When the robot is where the plan begins.
  Pose pose;                  ///< There.
};

/// A way home that was checked, beginning at the end of the active path.
struct KnownRoute {
  Path path;
  double travel_s = 0.0;
  navigation::PathMonitor monitor;
};

/// Why a new way to a point is needed.
enum class ReplanCause { kNone, kObstacle, kDeviation };

/// The flight to a point that was asked for.
struct GoToTask {
  NavigationJob job;  ///< Of the newest plan.
  /// The newest one; its path leads from where the robot was then to the point, unknown space
  /// included.
  navigation::NavigationAnswer plan;
  std::optional<navigation::PathMonitor> monitor;
  double taken_up_m = 0.0;  ///< The plan's length up to which it was checked and flown.
  ReplanCause cause = ReplanCause::kNone;
  std::vector<NoGoZone> unseen;  ///< Places on earlier plans that did not come into view.
  Eigen::Vector3d replanned_at = Eigen::Vector3d::Zero();
  int fruitless = 0;        ///< Replans since the robot last got somewhere.
  bool is_suspect = false;  ///< A voxel on the plan became occupied since the last look.
  double next_look_s = 0.0;
  double stopped_s = 0.0;  ///< When the last leg ended.
};

struct WayHome {
  Path path;
  double travel_s = 0.0;        ///< Not pessimistic.
  bool follows_active = false;  ///< Begins with the rest of the active path.
};

constexpr double kBodyShare = 0.5;  // of the safety box: returns from there are the robot itself

/// A place as messages name it, metres: "(1.0, 2.0, 3.0)".
[[nodiscard]] std::string placeOf(const Eigen::Vector3d& point);

/// Why the robot goes home. On the way it looks again for what it can afford if it was endurance.
enum class HomeCause { kEndurance, kOther };

/// State and steps of the mission. Steps that belong together share a .cpp:
/// mission_inputs, mission_goto, mission_goto_plans, mission_cycle, mission_ground, mission_plans,
/// mission_home, mission_way_home.
struct Mission::Impl {
  Impl(const MissionParams& mission_params, const RobotModel& robot_model,
       const map::MapParams& map_params, std::uint64_t seed,
       const terrain::TerrainParams& terrain_params);

  // --- Inputs (mission_inputs.cpp).
  void takeOdometry(const RobotState& state);
  void watchForFall(const RobotState& base);
  map::MapUpdate takeScan(const Scan& scan);
  ScanThinning& thinningOf(const std::string& sensor);
  [[nodiscard]] std::optional<std::string> faultOf(const Scan& scan) const;
  void takeRemaining(double remaining);
  Answer start();
  Answer pause();
  Answer goHomeAsAsked();
  Answer emergencyStop();
  void stopAtOnce(const std::string& why);
  Answer setBounds(const AxisAlignedBox& box);
  Answer setZones(std::vector<NoGoZone> list);
  [[nodiscard]] std::vector<NoGoZone> markedZones() const;
  [[nodiscard]] std::string startProblem();
  [[nodiscard]] MissionRecord record(const planners::PlannerGraph& graph) const;
  void takeUp(const MissionRecord& record);

  /// What the robot stands in, and some room around it, is free where it is unknown.
  void markStandFree();
  void takeOff();

  // --- Points from outside (mission_goto.cpp, mission_goto_plans.cpp).
  [[nodiscard]] std::optional<navigation::NavigationQuery> goToQuery(const Eigen::Vector3d& point);
  Answer goTo(const navigation::NavigationParams& params, const navigation::NavigationQuery& query,
              const navigation::NavigationAnswer& answer);
  [[nodiscard]] std::string goToProblem(const Eigen::Vector3d& point);
  void stepGoTo();
  void endGoTo(GoToOutcome outcome, const std::string& why);
  void noteAbortedGoTo();
  void lookAhead();
  void takeUpMore();
  [[nodiscard]] bool isPlanBlocked();
  [[nodiscard]] std::string flyPlan(double from_m, double to_m);
  void replan();
  void noteUnseen();
  void askForWay();
  void acceptGoTo(const navigation::NavigationAnswer& answer);
  void installPlan(const navigation::NavigationAnswer& answer);
  [[nodiscard]] std::optional<planners::PlanRequest> requestHere(double now_s);

  // --- The cycle (mission_cycle.cpp).
  std::optional<Command> tick(double now_s);
  void updateRemaining();
  [[nodiscard]] bool isFlying() const;
  void checkInputs();
  void checkDeviation();
  void checkLag();
  void leavePath(double gap_m);
  void checkArrival();
  void checkAhead();
  void checkEndurance();
  void enter(MissionState next, const std::string& why);
  void hold(const std::string& why, planners::PathOutcome outcome);
  void say(LogLevel level, const std::string& key, const std::string& text);
  [[nodiscard]] bool isAtRest() const;
  std::optional<Command> takeCommand();
  /// A path of the robot's box as one of its base.
  [[nodiscard]] Path ofBase(Path path) const;

  // --- The ground under a robot with legs (mission_ground.cpp).
  void noteGround(const Scan& scan);
  void checkGround();
  [[nodiscard]] Pose standing() const;
  [[nodiscard]] double scanAge() const;
  [[nodiscard]] bool looksAgain(const Eigen::Vector3d& unseen);
  [[nodiscard]] bool wasWalkedOn(const terrain::PathGroundCheck& bad) const;
  [[nodiscard]] bool isFootOfWall(const terrain::PathGroundCheck& bad);
  void avoid(const terrain::PathGroundCheck& bad);
  void stepBackOff();
  [[nodiscard]] Path motionAhead(double length_m) const;
  [[nodiscard]] bool isWalkable(const Path& path);
  [[nodiscard]] HomeGraph::Footing footingCheck();

  // --- Plans (mission_plans.cpp).
  void askForPlan();
  [[nodiscard]] bool wantsPlan() const;
  [[nodiscard]] bool wantsPlanInFlight() const;
  [[nodiscard]] bool wantsSecondLook() const;
  void makeJob();
  std::optional<Command> accept(const PlanOutcome& outcome, double now_s);
  /// The planner's path with the full safety box; where the robot's margin already touches
  /// something, its first short step out of there with the body alone.
  [[nodiscard]] navigation::PathCheck checkProposal(const Path& path) {
    return checkLeaving(path, robot.box_m, no_go, limits);
  }
  [[nodiscard]] navigation::PathCheck checkLeaving(const Path& path, const Eigen::Vector3d& box,
                                                   const std::vector<NoGoZone>& zones,
                                                   const AxisAlignedBox& bounds);
  void acceptExploration(const RunningJob& job, const PlanOutcome& outcome);
  void acceptSecondLook(const RunningJob& job, const PlanOutcome& outcome);
  void flyProposal(const Path& path, const Path& rest, const PlanOutcome& outcome);
  void acceptWayHome(const RunningJob& job, const planners::PlanResult& home);
  /// A way home that was only seen may prove blocked. Whether there is time to find that out at its
  /// end, to come back and to fly the `known` one, or that one is cut or takes too long anyway.
  [[nodiscard]] bool isWorthTheRisk(double travel_s, const std::optional<WayHome>& known);
  void onNoPlan(const RunningJob& job, const planners::PlanResult& plan);
  void onFailedPlan(const std::string& why);
  void refuse(const std::string& why, planners::PathOutcome outcome);
  [[nodiscard]] Path joined(const RunningJob& job, const Path& path) const;
  [[nodiscard]] double affordableLength(const Path& path, const std::optional<Path>& home_path);
  [[nodiscard]] Trajectory smoothest(const Path& path, const navigation::MotionStart& start,
                                     const Eigen::Vector3d& box);
  void fly(const Path& path, planners::PathKind kind, const Eigen::Vector3d& box) {
    fly(path, kind, box, box);
  }
  /// Corners are rounded as far as `corner_box`, which may be larger, stays free.
  void fly(const Path& path, planners::PathKind kind, const Eigen::Vector3d& box,
           const Eigen::Vector3d& corner_box);

  // --- The way home (mission_home.cpp).
  void noteRoute(const Path& rest, const planners::PlanResult& home);
  [[nodiscard]] std::optional<WayHome> wayByTrail();
  [[nodiscard]] std::optional<WayHome> wayByRoute() const;
  void refreshWayHome();
  void goHome(const std::string& why, HomeCause cause);
  void stepHome();
  void launchHome();
  void onNoWayHome(const RunningJob& job, const planners::PlanResult& home);
  [[nodiscard]] Path fromMotion(const WayHome& way) const;
  /// The configuration space of a box in the map as it is now.
  [[nodiscard]] map::ConfigurationSpace& spaceOf(
      const Eigen::Vector3d& box, map::Passable passable = map::Passable::kKnownFree);
  [[nodiscard]] bool isWayClear(const Path& path, const Eigen::Vector3d& box);
  /// The same for the robot's own trail, where marked ground has been walked on.
  [[nodiscard]] bool isTrailClear(const Path& path, const Eigen::Vector3d& box);
  [[nodiscard]] bool isAtHome() const;

  // --- Another way home when the trail is cut (mission_way_home.cpp).
  [[nodiscard]] WayHomeSearch searchForWayHome(const RunningJob& job);
  void addQuery(WayHomeSearch& search, const RunningJob& job, const std::optional<Pose>& goal_pose,
                const Eigen::Vector3d& box) const;
  [[nodiscard]] std::optional<Pose> placeAtHome(const Eigen::Vector3d& box);
  [[nodiscard]] std::vector<Pose> placesOnTrail();
  [[nodiscard]] bool flyWayFound(const planners::PlanResult& found);
  [[nodiscard]] std::string whatBlocksWayHome();

  // --- Parts.
  MissionParams params;
  RobotModel robot;
  map::OccupancyMap map;
  std::optional<terrain::TerrainMap> terrain;
  Rng rng;
  InputGuard input;
  EnduranceGuard guard;
  Throttle throttle;
  std::optional<HomeGraph> home_graph;
  std::optional<PathExecution> active;
  std::optional<KnownRoute> route;
  std::optional<GoToTask> go_to;

  // --- State.
  MissionState state = MissionState::kIdle;
  Goal goal = Goal::kNone;
  MissionStatus status;
  double now = 0.0;
  std::optional<double> started_s;
  double endurance_at_start_s = robot.endurance_s;  ///< Where no battery reports it.
  std::optional<double> last_odometry_s;
  std::optional<double> last_scan_s;  ///< Came in.
  double newest_scan_s = 0.0;         ///< Was taken.
  std::optional<double> reported_remaining_s;
  std::optional<std::string> input_fault;
  bool inputs_ok = false;
  Pose last_pose;  ///< Of the newest good odometry.
  double hold_since_s = 0.0;
  int scans = 0;
  AxisAlignedBox limits;
  std::vector<NoGoZone> no_go;        ///< All of them.
  std::vector<NoGoZone> given_zones;  ///< Those that people set; the rest was marked on the way.
  std::shared_ptr<const map::FrozenMap> frozen;
  std::deque<map::ConfigurationSpace> spaces;  ///< One a box that was asked for.
  Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();  ///< Newest, of the base itself.
  double next_ground_check_s = 0.0;
  std::map<std::string, ScanThinning> thinnings;  ///< By sensor.
  std::optional<Eigen::Vector3d> unseen_place;    ///< The robot has stood before it to look.
  double next_retime_s = 0.0;
  bool backs_off = false;
  std::optional<double> tilted_since_s;  ///< A robot with legs lies on its side since then.

  // --- Plans.
  std::optional<PlanJob> pending;
  std::optional<RunningJob> running;
  std::uint64_t next_job = 1;
  double next_ask_s = 0.0;
  double last_accept_s = 0.0;
  double latency_s = 0.0;
  int failures = 0;
  bool wants_way_home = false;
  bool may_look_again = false;  ///< On this way home.
  double next_look_s = 0.0;
  bool asks_navigation = false;  ///< The next way home is the mission's own search.
  std::string home_obstacle;     ///< What lay between the robot and home at the last try.
  planners::PathOutcome last_outcome = planners::PathOutcome::kNone;
  std::string last_reason;

  // --- What there is to see.
  std::vector<planners::StampedPose> stamped_trail;
  std::vector<planners::RemainingTarget> remaining_targets;
  Path way_home;
  double way_home_s = 0.0;
  double next_refresh_s = 0.0;
  double next_merge_s = 0.0;
  std::optional<Command> command;
};

}  // namespace spelunk::mission
