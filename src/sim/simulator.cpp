#include "spelunk/sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/battery.h"
#include "spelunk/sim/multirotor.h"
#include "spelunk/sim/odometry.h"
#include "spelunk/sim/range_sensor.h"
#include "spelunk/sim/start_check.h"
#include "spelunk/sim/walker.h"
#include "spelunk/sim/world_events.h"

namespace spelunk::sim {
namespace {

constexpr double kEpisodeGap = 0.5;      ///< Seconds parted after which a contact counts anew.
constexpr double kTimeTolerance = 1e-9;  ///< Seconds.

void requireUsable(const SimParams& params, const WorldMesh& mesh) {
  if (mesh.triangles.empty()) throw OutsideError("world '" + mesh.name + "' holds no triangles");
  std::string text;
  for (const std::string& problem : params.problems()) text += (text.empty() ? "" : "; ") + problem;
  if (!text.empty()) throw OutsideError(text);
}

void requireFollowable(const Trajectory& trajectory) {
  double last_s = -std::numeric_limits<double>::infinity();
  for (const TrajectoryPoint& point : trajectory) {
    require(isFinite(point.pose) && point.velocity.allFinite() && std::isfinite(point.time_s),
            "Simulator::follow: trajectory is not finite");
    require(point.time_s > last_s, "Simulator::follow: times do not rise");
    last_s = point.time_s;
  }
}

/// Counts contacts: one episode until parted for kEpisodeGap.
class ContactLog {
 public:
  void add(double time_s, double step_s, bool is_in_contact) {
    if (!is_in_contact) return;
    if (count_.episodes == 0 || time_s - last_contact_s_ > kEpisodeGap) ++count_.episodes;
    count_.seconds += step_s;
    last_contact_s_ = time_s;
  }
  [[nodiscard]] CollisionCount count() const { return count_; }

 private:
  CollisionCount count_;
  double last_contact_s_ = 0.0;
};

Eigen::Isometry3d toIsometry(const BodyState& body) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(body.position);
  transform.rotate(body.orientation);
  return transform;
}

RobotState toRobotState(double stamp_s, const BodyState& body) {
  RobotState state;
  state.stamp_s = stamp_s;
  state.pose = poseOf(toIsometry(body));
  state.orientation = body.orientation;
  state.velocity = body.velocity;
  state.yaw_rate = (body.orientation * body.angular_velocity).z();
  return state;
}

/// What a drive command lost to the limits.
std::string reductionText(const DriveCommand& wanted, const DriveCommand& executed) {
  std::ostringstream text;
  const auto compare = [&](const char* what, double from, double to, const char* unit) {
    if (from != to)
      text << (text.str().empty() ? "" : ", ") << what << " " << from << " to " << to << " "
           << unit;
  };
  compare("forward", wanted.forward_mps, executed.forward_mps, "m/s");
  compare("sideways", wanted.sideways_mps, executed.sideways_mps, "m/s");
  compare("yaw rate", wanted.yaw_rate_radps, executed.yaw_rate_radps, "rad/s");
  return text.str().empty() ? "" : "drive command above the robot's limits, reduced: " + text.str();
}

}  // namespace

std::vector<std::string> SimParams::problems() const {
  std::vector<std::string> found;
  if (rotors != 4 && rotors != 6) found.emplace_back("sim.rotors must be 4 or 6");
  const double largest = inertia_kgm2.maxCoeff();
  if (inertia_kgm2.sum() - largest < largest)
    found.emplace_back("sim.inertia_kgm2: no moment can exceed the sum of the other two");
  return found;
}

std::vector<std::string> SimParams::problemsFor(const RobotModel& robot) const {
  constexpr double kSameHeight_m = 0.05;  // legs give so much
  std::vector<std::string> found;
  const bool is_legged = kindOf(robot) == RobotKind::kLegged;
  const Eigen::Vector3d& body = is_legged ? walker.trunk_m : body_m;
  if ((body.array() > robot.box_m.array()).any())
    found.push_back(std::string(is_legged ? "walker.trunk_m" : "sim.body_m") + " = " +
                    toText(body) + " does not fit into robot.box_m = " + toText(robot.box_m) +
                    ", which keeps the robot clear of obstacles: enlarge the box, or make the body "
                    "smaller" +
                    (is_legged ? "" : " (left out, it follows from the box)"));
  if (is_legged && std::fabs(walker.stand_height_m - robot.ride_height_m) > kSameHeight_m)
    found.push_back("walker.stand_height_m = " + toText(walker.stand_height_m) +
                    " and robot.ride_height_m = " + toText(robot.ride_height_m) +
                    " are the same height of the base above the ground: set both alike");
  return found;
}

Eigen::Vector3d bodyWithin(const Eigen::Vector3d& box_m) {
  const Eigen::Array3d shares{7.0 / 11.0, 7.0 / 11.0, 3.0 / 4.0};  // 0.7 of 1.1 m, 0.3 of 0.4 m
  return (1000.0 * shares * box_m.array()).round() / 1000.0;
}

namespace {

SimParams readSimParams(ParamTree& tree, SimParams params) {
  tree.read("sim", params);
  tree.read("walker", params.walker);
  for (const std::string& problem : params.problems()) tree.addProblem(problem);
  for (const std::string& problem : params.walker.problems()) tree.addProblem(problem);
  return params;
}

}  // namespace

SimParams readSimParams(ParamTree& tree) { return readSimParams(tree, SimParams{}); }

SimParams readSimParams(ParamTree& tree, const RobotModel& robot) {
  SimParams defaults;
  defaults.body_m = bodyWithin(robot.box_m);
  const SimParams params = readSimParams(tree, defaults);
  for (const std::string& problem : params.problemsFor(robot)) tree.addProblem(problem);
  return params;
}

struct Simulator::Impl {
  Impl(const SimParams& sim_params, const RobotModel& robot, const WorldMesh& mesh,
       const Pose& start, std::uint64_t seed)
      : params(sim_params),
        scene(mesh),
        vehicle(makeVehicle(robot, mesh, start)),
        limits(limitsFor(robot)),
        battery(walker ? walkingPower(params.walker) : flightPower(params), params.battery_wh,
                robot),
        odometry(params.odometry_drift, params.odometry_noise_m, vehicle->state(),
                 Rng(seed).fork("sim/odometry")),
        events(params.events),
        reference(start, robot.braking_deceleration_mps2) {
    for (const SensorModel& model : robot.sensor_models)
      sensors.emplace_back(model, params.dust_returns, Rng(seed).fork("sim/sensor"),
                           params.self_returns_m);
  }

  std::unique_ptr<Vehicle> makeVehicle(const RobotModel& robot, const WorldMesh& mesh,
                                       const Pose& start) {
    if (kindOf(robot) == RobotKind::kAerial)
      return std::make_unique<Multirotor>(params, mesh, scene, start);
    auto made = std::make_unique<Walker>(params.walker, robot, mesh, scene, start);
    walker = made.get();
    return made;
  }

  [[nodiscard]] DriveLimits limitsFor(const RobotModel& robot) const {
    if (walker != nullptr) return walkingLimits(robot, params.walker);
    const double speed = robot.speed_max_mps;
    return {speed, speed, speed, robot.yaw_rate_max_radps};
  }

  [[nodiscard]] double timeAfter(std::int64_t step_count) const {
    return static_cast<double>(step_count) / params.physics_rate_hz;
  }

  void stepOnce() {
    const double step_s = 1.0 / params.physics_rate_hz;
    const double time_s = timeAfter(steps);
    const double speed_mps = vehicle->state().velocity.norm();
    const BodyState estimate = odometry.estimate();
    reference.update(time_s, estimate);
    vehicle->step(step_s, time_s, estimate, reference,
                  battery.isEmpty() ? Power::kOff : Power::kOn);
    ++steps;
    odometry.advance(vehicle->state());
    correctOdometryBetween(time_s, timeAfter(steps));
    battery.draw(step_s, speed_mps);
    const Eigen::Vector3d& position = vehicle->state().position;
    events.update(timeAfter(steps), position);
    contacts.add(timeAfter(steps), step_s,
                 vehicle->isInContact() || events.touches(position, vehicle->bodySize()));
  }

  void correctOdometryBetween(double from_s, double to_s) {
    for (const double at_s : params.odometry_jumps_s)
      if (at_s > from_s && at_s <= to_s)
        odometry.correct(params.odometry_jump_m, params.odometry_jump_deg * M_PI / 180.0);
  }

  void takeDueScans(std::vector<SimulatedScan>& scans) {
    const double time_s = timeAfter(steps);
    for (RangeSensor& sensor : sensors) {
      if (sensor.nextScanTime() > time_s + kTimeTolerance) continue;
      auto scan = sensor.scan(scene, toIsometry(vehicle->state()),
                              toIsometry(odometry.measurement()), time_s, events);
      if (scan) scans.push_back(std::move(*scan));
    }
  }

  SimParams params;
  MeshScene scene;
  Walker* walker = nullptr;  ///< The vehicle, if it walks.
  std::unique_ptr<Vehicle> vehicle;
  DriveLimits limits;
  Battery battery;
  Odometry odometry;
  ContactLog contacts;
  std::vector<RangeSensor> sensors;
  WorldEvents events;
  MotionReference reference;
  int reduced_drives = 0;
  std::int64_t steps = 0;
};

Simulator::Simulator(const SimParams& params, const RobotModel& robot, const WorldMesh& mesh,
                     const Pose& start, std::uint64_t seed) {
  requireUsable(params, mesh);
  requireInside(mesh, start);
  impl_ = std::make_unique<Impl>(params, robot, mesh, start, seed);
}
Simulator::~Simulator() = default;

void Simulator::castOnlyMappedScans() {
  for (RangeSensor& sensor : impl_->sensors) sensor.castOnlyMapped();
}

void Simulator::follow(Trajectory trajectory) {
  requireFollowable(trajectory);
  impl_->reference.follow(std::move(trajectory), time(), impl_->odometry.estimate());
}

DriveAnswer Simulator::drive(const DriveCommand& command) {
  require(std::isfinite(command.forward_mps) && std::isfinite(command.sideways_mps) &&
              std::isfinite(command.yaw_rate_radps),
          "Simulator::drive: command is not finite");
  DriveAnswer answer;
  answer.executed = clamped(command, impl_->limits);
  answer.warning = reductionText(command, answer.executed);
  if (!answer.warning.empty()) ++impl_->reduced_drives;
  impl_->reference.drive(answer.executed, time());
  return answer;
}

void Simulator::take(Posture posture) {
  if (impl_->walker != nullptr) impl_->walker->take(posture);
}

int Simulator::reducedDrives() const { return impl_->reduced_drives; }

std::vector<SimulatedScan> Simulator::advanceTo(double time_s) {
  require(std::isfinite(time_s), "Simulator::advanceTo: time is not finite");
  std::vector<SimulatedScan> scans;
  impl_->takeDueScans(scans);
  while (impl_->timeAfter(impl_->steps + 1) <= time_s + kTimeTolerance) {
    impl_->stepOnce();
    impl_->takeDueScans(scans);
  }
  return scans;
}

double Simulator::time() const { return impl_->timeAfter(impl_->steps); }
RobotState Simulator::trueState() const { return toRobotState(time(), impl_->vehicle->state()); }
RobotState Simulator::odometry() const {
  return toRobotState(time(), impl_->odometry.measurement());
}
BatteryState Simulator::battery() const { return impl_->battery.state(); }
CollisionCount Simulator::collisions() const { return impl_->contacts.count(); }
const MeshScene& Simulator::scene() const { return impl_->scene; }
Eigen::Vector3d Simulator::bodySize() const { return impl_->vehicle->bodySize(); }

WalkerCount Simulator::walkerCount() const {
  return impl_->walker ? impl_->walker->count() : WalkerCount{};
}
JointState Simulator::joints() const {
  return impl_->walker ? impl_->walker->joints() : JointState{};
}
std::vector<FootState> Simulator::feet() const {
  return impl_->walker ? impl_->walker->feet() : std::vector<FootState>{};
}

}  // namespace spelunk::sim
