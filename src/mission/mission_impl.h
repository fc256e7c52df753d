#pragma once

#include <optional>
#include <string>

#include "spelunk/common/log.h"
#include "spelunk/mission/basis.h"
#include "spelunk/mission/ground_watch.h"
#include "spelunk/mission/mission.h"
#include "spelunk/mission/mission_store.h"
#include "spelunk/mission/plan_desk.h"
#include "spelunk/mission/point_flight.h"
#include "spelunk/mission/proposal.h"
#include "spelunk/mission/transitions.h"
#include "spelunk/mission/vertical_flight.h"
#include "spelunk/mission/way_home.h"

namespace spelunk::mission {

/// The parts of a mission and what makes them one: every event goes through happens(), which asks
/// the table of transitions and carries its action out; every path goes through fly(). The parts
/// know nothing of the task. mission_tick.cpp: the order of the tick; mission_events.cpp: what
/// happens; mission_answers.cpp: what becomes of plans; mission_inputs.cpp: what comes from
/// outside.
struct Mission::Impl {
  Impl(const MissionParams& mission_params, const RobotModel& robot_model,
       const map::MapParams& map_params, std::uint64_t seed,
       const terrain::TerrainParams& terrain_params);

  // --- What comes from outside.
  void takeOdometry(const RobotState& state);
  map::MapUpdate takeScan(const Scan& scan);
  void takeRemaining(double remaining_s);
  Answer start();
  Answer pause();
  Answer goHomeAsAsked();
  Answer emergencyStop();
  Answer setBounds(const AxisAlignedBox& box);
  [[nodiscard]] std::string startProblem();
  [[nodiscard]] std::string withDoubt(const std::string& why) const;
  [[nodiscard]] std::string goToProblem(const Eigen::Vector3d& point);
  Answer goTo(const Eigen::Vector3d& target, const navigation::NavigationParams& navigation,
              double time_limit_s);
  void markStandFree();
  void takeOff();
  [[nodiscard]] MissionRecord record(const planners::PlannerGraph& graph) const;
  void takeUp(const MissionRecord& record);

  // --- What happens.
  void happens(Event event, const std::string& why);
  void resetForNewTask(Event event, const std::string& why);
  void hold(Event event, const std::string& why);
  void turnHome(Event event, Task before, const std::string& why);
  void fly(const Leg& leg);
  [[nodiscard]] bool isFullBox(const Leg& leg) const;
  void launchHome();
  void standUp();
  void show(MissionState next, const std::string& why);
  void say(LogLevel level, const std::string& key, const std::string& text);

  // --- The steps of the tick.
  std::optional<Command> tick(double now_s);
  void updatePose();
  void updateEndurance();
  void updateWayHome();
  void checkPromise();
  void checkInputs();
  void checkPath();
  void checkArrival();
  void checkAhead();
  void checkGround();
  void backOff();
  void checkEndurance();
  void checkCause();
  void stepTakeOff();
  void stepHome();
  void stepLanding();
  void stepPoint();
  void askForPlan();

  // --- What becomes of plans.
  void take(const PlanOutcome& outcome, double now_s);
  void askForPoint();
  void acceptExploration(const RunningJob& job, const PlanOutcome& outcome);
  void acceptSecondLook(const RunningJob& job, const PlanOutcome& outcome);
  void acceptWayHome(const RunningJob& job, const planners::PlanResult& home);
  void acceptStep(const PointStep& step);
  void flyProposal(const Path& path, const Path& rest, const PlanOutcome& outcome);
  void refuse(const Verdict& verdict, const planners::PlanResult& plan);
  void noteNoPlan(const RunningJob& job, const planners::PlanResult& plan);
  void noteFailure(const std::string& fault);
  void noteNoWayHome(const RunningJob& job, const planners::PlanResult& home);

  [[nodiscard]] MissionStatus status() const;
  [[nodiscard]] bool isAtRest() const { return flight.isAtRest(watch.state().velocity, now); }
  [[nodiscard]] bool mayMove() const { return inputs_ok && now >= resume_s; }
  /// A path of the robot's box as one of its base.
  [[nodiscard]] Path ofBase(Path path) const;

  // --- What it was made of.
  const MissionParams params;
  const RobotModel robot;
  // --- Parts that know no other part.
  SafeSpace space;
  RobotWatch watch;
  Endurance endurance;
  Flight flight;
  // --- Parts that look at those.
  const Basis basis;
  WayHome way_home;
  GroundWatch ground;
  VerticalFlight vertical;
  PointFlight point;
  PlanDesk desk;

  // --- State of the mission itself.
  double now = 0.0;  ///< Mission time of the newest tick or answer.
  Task task = Task::kIdle;
  bool inputs_ok = false;                ///< At the last tick.
  double resume_s = 0.0;                 ///< Until then it holds, for people to see why.
  Event turned_for = Event::kHomeAsked;  ///< Why it goes home.
  double next_cause_check_s = 0.0;
  InputNotes notes;
  // What there is to see of it.
  MissionState shown = MissionState::kIdle;
  std::string reason;
  std::string end_reason;
  std::string way_home_problem;
  int replans_obstacle = 0;
  int replans_deviation = 0;
  double last_map_update_ms = 0.0;
  Throttle throttle;
};

}  // namespace spelunk::mission
