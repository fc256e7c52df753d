#include "spelunk/sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "spelunk/common/contract.h"
#include "spelunk/sim/battery.h"
#include "spelunk/sim/flight_controller.h"
#include "spelunk/sim/odometry.h"
#include "spelunk/sim/range_sensor.h"
#include "spelunk/sim/rigid_body.h"
#include "spelunk/sim/rotors.h"

namespace spelunk::sim {
namespace {

constexpr double kEpisodeGap = 0.5;      ///< Seconds parted after which a contact counts anew.
constexpr double kTimeTolerance = 1e-9;  ///< Seconds.

std::string textOf(const Pose& pose) {
  std::ostringstream text;
  text << "(" << pose.position.x() << ", " << pose.position.y() << ", " << pose.position.z() << ")";
  return text.str();
}

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

/// Refuses a start from which no flight can begin.
void requireFreeStart(const MeshScene& scene, const WorldMesh& mesh, const SimParams& params,
                      const Pose& start) {
  if (!isFinite(start)) throw OutsideError("start pose is not finite; give numbers x,y,z,yaw");
  if (!mesh.bounds().contains(start.position))
    throw OutsideError("start " + textOf(start) + " lies outside the world '" + mesh.name +
                       "'; give a start inside the mesh (--start x,y,z,yaw)");
  if (scene.boxDistance(start.position, params.body_m, 1.0) > 0.0) return;
  std::ostringstream text;
  text << "start " << textOf(start) << " is in collision with the world '" << mesh.name
       << "': clearance " << scene.distanceTo(start.position, 100.0)
       << " m from the centre, the body is " << params.body_m.transpose()
       << " m; choose a start farther from walls (--start x,y,z,yaw) or a smaller sim.body_m";
  throw OutsideError(text.str());
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

}  // namespace

std::vector<std::string> SimParams::problems() const {
  std::vector<std::string> found;
  if (rotors != 4 && rotors != 6) found.emplace_back("sim.rotors must be 4 or 6");
  const double largest = inertia_kgm2.maxCoeff();
  if (inertia_kgm2.sum() - largest < largest)
    found.emplace_back("sim.inertia_kgm2: no moment can exceed the sum of the other two");
  return found;
}

struct Simulator::Impl {
  Impl(const SimParams& sim_params, const RobotModel& robot, const WorldMesh& mesh,
       const Pose& start, std::uint64_t seed)
      : params(sim_params),
        braking_mps2(robot.braking_deceleration_mps2),
        scene(mesh),
        airframe{params.mass_kg, params.inertia_kgm2, params.drag_coefficient,
                 params.thrust_to_weight * params.mass_kg * kGravity},
        rotors(params.rotors, params.rotor_arm_m, params.rotor_lag_s, airframe.thrust_max_n),
        body(mesh, {params.mass_kg, params.inertia_kgm2, params.body_m}, start),
        battery(params, robot),
        odometry(params.odometry_drift, params.odometry_noise_m, body.state(),
                 Rng(seed).fork("sim/odometry")) {
    requireFreeStart(scene, mesh, params, start);
    for (const SensorModel& model : robot.sensor_models)
      sensors.emplace_back(model, params.dust_returns, Rng(seed).fork("sim/sensor"));
    TrajectoryPoint hover;
    hover.pose = start;
    reference = {hover};
    rotors.spinUp(params.mass_kg * kGravity);
  }

  [[nodiscard]] double timeAfter(std::int64_t step_count) const {
    return static_cast<double>(step_count) / params.physics_rate_hz;
  }

  void stepOnce() {
    const double step_s = 1.0 / params.physics_rate_hz;
    const double time_s = timeAfter(steps);
    const BodyState truth = body.state();
    const TrajectoryPoint ahead = stateAt(reference, time_s + kAccelerationPreview);
    rotors.command(battery.isEmpty()
                       ? Wrench{}
                       : computeWrench(airframe, odometry.estimate(), stateAt(reference, time_s),
                                       ahead.acceleration));
    rotors.advance(step_s);
    body.step(step_s, rotors.wrench(), -params.drag_coefficient * truth.velocity);
    ++steps;
    odometry.advance(body.state());
    battery.draw(step_s, truth.velocity.norm());
    contacts.add(timeAfter(steps), step_s, body.isInContact());
  }

  void takeDueScans(std::vector<SimulatedScan>& scans) {
    const double time_s = timeAfter(steps);
    for (RangeSensor& sensor : sensors) {
      if (sensor.nextScanTime() > time_s + kTimeTolerance) continue;
      scans.push_back(
          sensor.scan(scene, toIsometry(body.state()), toIsometry(odometry.measurement()), time_s));
    }
  }

  SimParams params;
  double braking_mps2;
  MeshScene scene;
  Airframe airframe;
  Rotors rotors;
  RigidBody body;
  Battery battery;
  Odometry odometry;
  ContactLog contacts;
  std::vector<RangeSensor> sensors;
  Trajectory reference;
  std::int64_t steps = 0;
};

Simulator::Simulator(const SimParams& params, const RobotModel& robot, const WorldMesh& mesh,
                     const Pose& start, std::uint64_t seed) {
  requireUsable(params, mesh);
  impl_ = std::make_unique<Impl>(params, robot, mesh, start, seed);
}
Simulator::~Simulator() = default;

void Simulator::follow(Trajectory trajectory) {
  requireFollowable(trajectory);
  if (!trajectory.empty()) {
    impl_->reference = std::move(trajectory);
    return;
  }
  const RobotState now = toRobotState(time(), impl_->odometry.estimate());
  TrajectoryPoint from;
  from.pose = now.pose;
  from.velocity = now.velocity;
  from.yaw_rate = now.yaw_rate;
  impl_->reference = brakingTrajectory(time(), from, impl_->braking_mps2);
}

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
RobotState Simulator::trueState() const { return toRobotState(time(), impl_->body.state()); }
RobotState Simulator::odometry() const {
  return toRobotState(time(), impl_->odometry.measurement());
}
BatteryState Simulator::battery() const { return impl_->battery.state(); }
CollisionCount Simulator::collisions() const { return impl_->contacts.count(); }
const MeshScene& Simulator::scene() const { return impl_->scene; }

}  // namespace spelunk::sim
