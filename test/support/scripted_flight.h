#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "spelunk/common/log.h"
#include "spelunk/common/trajectory.h"
#include "spelunk/mission/mission.h"
#include "support/grid_world.h"

namespace spelunk::test {

/// A planner that says what a test tells it to.
class ScriptedPlanner : public planners::ExplorationPlanner {
 public:
  std::function<planners::PlanResult(const planners::PlanRequest&)> on_plan;
  std::function<planners::PlanResult(const planners::PlanRequest&)> on_home;
  std::vector<planners::PlanRequest> requests;

  static planners::PlanResult none(planners::PlanStatus status) {
    planners::PlanResult result;
    result.status = status;
    result.reason = "the script says so";
    return result;
  }
  static planners::PlanResult path(Path path, planners::PathKind kind) {
    planners::PlanResult result;
    result.status = planners::PlanStatus::kOk;
    result.kind = kind;
    result.path = std::move(path);
    result.reason = "the script says so";
    return result;
  }

  [[nodiscard]] planners::PlannerGraph graph() const override { return {}; }
  void restore(const planners::PlannerGraph& /*graph*/) override {}
  std::vector<planners::PathReport> reports;

 private:
  planners::PlanResult doPlan(const planners::PlanRequest& request) override {
    requests.push_back(request);
    return on_plan ? on_plan(request) : none(planners::PlanStatus::kNothingToGain);
  }
  planners::PlanResult doPlanHome(const planners::PlanRequest& request) override {
    return on_home ? on_home(request) : none(planners::PlanStatus::kNoPath);
  }
  void doReport(const planners::PathReport& report) override { reports.push_back(report); }
};

/// A coarse sensor, robot and map for grid worlds.
inline SensorModel coarseLidar() {
  SensorModel sensor;
  sensor.name = "coarse";
  sensor.fov_vertical_deg = 70.0;
  sensor.rows = 20;
  sensor.columns = 180;
  sensor.range_min_m = 0.2;
  sensor.range_max_m = 15.0;  // beyond the map's: misses free their ray
  sensor.gain_range_m = 8.0;
  sensor.gain_resolution_deg = 10.0;
  return sensor;
}

inline RobotModel smallRobot() {
  RobotModel robot;
  robot.box_m = {0.8, 0.8, 0.4};
  robot.sensors = {"coarse"};
  robot.sensor_models = {coarseLidar()};
  return robot;
}

inline map::MapParams coarseMap() {
  map::MapParams params;
  params.resolution_m = 0.5;
  params.range_max_m = 12.0;
  params.range_min_m = 0.2;
  return params;
}

/// Flies a mission in a grid world with a robot that follows its reference exactly.
class ScriptedFlight {
 public:
  ScriptedFlight(GridWorld world, const Pose& start, planners::ExplorationPlanner& planner,
                 const mission::MissionParams& params = {}, std::uint64_t seed = 1,
                 const RobotModel& robot = smallRobot())
      : world_(std::move(world)), planner_(planner), mission_(params, robot, coarseMap(), seed) {
    state_.pose = start;
  }

  /// Senses for half a second, then starts.
  mission::Answer start() {
    for (int k = 0; k < 5; ++k) {
      sense();
      mission_.tick(now_);
      now_ += kStep_s;
    }
    return mission_.start();
  }

  /// One cycle of 0.1 s.
  void step() {
    now_ += kStep_s;
    move();
    sense();
    if (budget_s_) mission_.onRemaining(std::max(0.0, *budget_s_ - now_));
    obey(mission_.tick(now_));
    if (const auto job = mission_.takeJob()) {
      outcome_ = run(*job, planner_);
      outcome_due_s_ = now_ + plan_time_s_;
    }
    if (!outcome_ || now_ < outcome_due_s_) return;
    obey(mission_.accept(*outcome_, now_));
    outcome_.reset();
  }

  void flyFor(double seconds) {
    for (const double end = now_ + seconds; now_ < end;) step();
  }
  /// Until done or the budget is gone; false for the latter.
  bool flyToTheEnd(double limit_s) {
    while (mission_.status().state != mission::MissionState::kDone && now_ < limit_s) step();
    return mission_.status().state == mission::MissionState::kDone;
  }

  /// How long plans take; else they are there at once.
  void setPlanTime(double seconds) { plan_time_s_ = seconds; }
  void setBudget(double seconds) { budget_s_ = seconds; }
  void muteOdometry() { odometry_ = false; }
  void scanEvery(double period_s) {
    scan_steps_ = static_cast<int>(std::lround(period_s / kStep_s));
  }
  void muteScans() { scans_ = false; }
  /// No more than so many rays come back from now on, spread over all of them.
  void thinScans(std::size_t points) { points_max_ = points; }
  /// Odometry comes so seldom.
  void reportEvery(double period_s) { report_period_s_ = period_s; }
  /// Nobody carries out what is commanded from now on, or somebody does again.
  void ignoreCommands() { obeys_ = false; }
  void obeyCommands() { obeys_ = true; }
  void push(const Eigen::Vector3d& offset) { offset_ += offset; }

  [[nodiscard]] mission::Mission& mission() { return mission_; }
  [[nodiscard]] GridWorld& world() { return world_; }
  [[nodiscard]] const RobotState& state() const { return state_; }
  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] int collisions() const { return collisions_; }
  [[nodiscard]] int commands() const { return commands_; }
  [[nodiscard]] const std::optional<mission::Command>& lastCommand() const { return last_; }

 private:
  static constexpr double kStep_s = 0.1;

  void move() {
    state_.stamp_s = now_;
    if (trajectory_.empty()) {
      state_.velocity.setZero();
    } else {
      const TrajectoryPoint point = stateAt(trajectory_, now_);
      state_.pose = point.pose;
      state_.pose.position += offset_;
      state_.velocity = point.velocity;
      state_.yaw_rate = point.yaw_rate;
    }
    const Eigen::Vector3d body(0.5, 0.5, 0.3);
    if (world_.collides(boxAround(state_.pose.position, body))) ++collisions_;
  }
  void sense() {
    state_.stamp_s = now_;
    if (odometry_ && now_ > next_report_s_ - 1e-6) {
      mission_.onOdometry(state_);
      next_report_s_ = now_ + report_period_s_;
    }
    if (scans_ && ++senses_ % scan_steps_ == 1)
      mission_.onScan(thinned(world_.scan(mission_.robot().sensor_models[0], state_.pose, now_)));
  }
  [[nodiscard]] Scan thinned(Scan scan) const {
    if (scan.points.size() <= points_max_) return scan;
    const std::size_t step = scan.points.size() / points_max_;
    std::vector<Eigen::Vector3f> kept;
    for (std::size_t k = 0; kept.size() < points_max_; k += step) kept.push_back(scan.points[k]);
    scan.points = std::move(kept);
    return scan;
  }
  /// An emergency stop is taken as perfect: the tests look at what is commanded.
  void obey(const std::optional<mission::Command>& command) {
    if (!command) return;
    if (obeys_) trajectory_ = command->trajectory;
    offset_.setZero();
    last_ = command;
    ++commands_;
  }

  GridWorld world_;
  planners::ExplorationPlanner& planner_;
  mission::Mission mission_;
  RobotState state_;
  Trajectory trajectory_;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  std::optional<double> budget_s_;
  std::optional<mission::PlanOutcome> outcome_;
  double outcome_due_s_ = 0.0;
  double plan_time_s_ = 0.0;
  std::optional<mission::Command> last_;
  double now_ = 0.0;
  int senses_ = 0;
  int scan_steps_ = 2;  ///< Cycles a scan.
  int collisions_ = 0;
  int commands_ = 0;
  std::size_t points_max_ = std::numeric_limits<std::size_t>::max();
  double report_period_s_ = 0.0;
  double next_report_s_ = 0.0;
  bool odometry_ = true;
  bool scans_ = true;
  bool obeys_ = true;
};

}  // namespace spelunk::test
