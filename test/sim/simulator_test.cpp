#include "spelunk/sim/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "spelunk/common/contract.h"
#include "support/meshes.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

const Pose kStart{{0.0, 0.0, 2.0}, 0.0};

WorldMesh hall() { return test::boxRoom({30, 30, 6}); }

/// Straight legs at up to `speed_mps` with a stop at each corner.
Trajectory legs(double start_s, const std::vector<Vector3d>& corners, double speed_mps,
                double acceleration_mps2) {
  Trajectory trajectory;
  double time_s = start_s;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const Vector3d leg = corners[k + 1] - corners[k];
    const double length = leg.norm();
    const double peak = std::min(speed_mps, std::sqrt(acceleration_mps2 * length));
    const double ramp_s = peak / acceleration_mps2;
    const double cruise_s = length / peak - ramp_s;
    const double ramp_m = 0.5 * peak * ramp_s;
    const auto add = [&](double after_s, double arc_m, double speed) {
      TrajectoryPoint point;
      point.time_s = time_s + after_s;
      point.pose.position = corners[k] + arc_m / length * leg;
      point.pose.yaw = std::atan2(leg.y(), leg.x());
      point.velocity = speed / length * leg;
      trajectory.push_back(point);
    };
    if (k == 0) add(0.0, 0.0, 0.0);
    add(ramp_s, ramp_m, peak);
    if (cruise_s > 1e-6) add(ramp_s + cruise_s, length - ramp_m, peak);
    add(2.0 * ramp_s + cruise_s, length, 0.0);
    time_s += 2.0 * ramp_s + cruise_s;
  }
  return trajectory;
}

/// Constant speed round sharp corners, from a standing start: no vehicle follows it exactly.
Trajectory sharpZigzag(double start_s, double speed_mps) {
  const std::vector<Vector3d> corners{{0, 0, 2}, {6, 0, 2}, {6, 5, 3}, {0, 5, 2}, {4, -3, 2.5}};
  Trajectory trajectory;
  double time_s = start_s;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    TrajectoryPoint point;
    point.pose.position = corners[k];
    if (k > 0) time_s += (corners[k] - corners[k - 1]).norm() / speed_mps;
    if (k + 1 < corners.size())
      point.velocity = speed_mps * (corners[k + 1] - corners[k]).normalized();
    point.time_s = time_s;
    trajectory.push_back(point);
  }
  return trajectory;
}

double tiltOf(const RobotState& state) {
  return std::acos(std::clamp((state.orientation * Vector3d::UnitZ()).z(), -1.0, 1.0));
}

struct Flight {
  double rms_error_m = 0.0;
  double worst_error_m = 0.0;
  double worst_tilt_rad = 0.0;
};

Flight fly(Simulator& sim, const Trajectory& trajectory, double extra_s) {
  sim.follow(trajectory);
  Flight flight;
  int count = 0;
  for (double t = sim.time() + 0.02; t < trajectory.back().time_s + extra_s; t += 0.02) {
    sim.advanceTo(t);
    const double error =
        (sim.trueState().pose.position - stateAt(trajectory, sim.time()).pose.position).norm();
    flight.rms_error_m += error * error;
    flight.worst_error_m = std::max(flight.worst_error_m, error);
    flight.worst_tilt_rad = std::max(flight.worst_tilt_rad, tiltOf(sim.trueState()));
    ++count;
  }
  flight.rms_error_m = std::sqrt(flight.rms_error_m / count);
  return flight;
}

class AnyFrame : public testing::TestWithParam<int> {
 protected:
  static SimParams params() {
    SimParams params;
    params.rotors = GetParam();
    return params;
  }
};

TEST_P(AnyFrame, HoversWhereItStarts) {
  Simulator sim(params(), RobotModel{}, hall(), kStart, 1);
  sim.advanceTo(10.0);
  EXPECT_NEAR(sim.time(), 10.0, 1e-9);
  EXPECT_LT((sim.trueState().pose.position - kStart.position).norm(), 0.01);
  EXPECT_LT(tiltOf(sim.trueState()), 0.01);
  EXPECT_EQ(sim.collisions().episodes, 0);
}

TEST_P(AnyFrame, TracksLegsAtTwoMetresASecond) {
  Simulator sim(params(), RobotModel{}, hall(), kStart, 1);
  const Trajectory path =
      legs(0.5, {{0, 0, 2}, {8, 0, 2}, {8, 6, 3}, {2, 6, 1.5}, {-5, -5, 2}}, 2.0, 2.0);
  const Flight flight = fly(sim, path, 1.0);
  EXPECT_LT(flight.rms_error_m, 0.08);
  EXPECT_LT(flight.worst_error_m, 0.3);
  EXPECT_LT(flight.worst_tilt_rad, 0.7);
  EXPECT_LT((sim.trueState().pose.position - path.back().pose.position).norm(), 0.03);
  EXPECT_LT(std::abs(wrapAngle(sim.trueState().pose.yaw - path.back().pose.yaw)), 0.02);
}

TEST_P(AnyFrame, KeepsUprightOnCornersNobodyCanFly) {
  Simulator sim(params(), RobotModel{}, hall(), kStart, 1);
  const Flight flight = fly(sim, sharpZigzag(0.5, 2.0), 2.0);
  EXPECT_LT(flight.rms_error_m, 0.15);
  EXPECT_LT(flight.worst_tilt_rad, 0.9);
  EXPECT_EQ(sim.collisions().episodes, 0);
}

INSTANTIATE_TEST_SUITE_P(Simulator, AnyFrame, testing::Values(4, 6));

TEST(Simulator, StopsInBrakingDistance) {
  RobotModel robot;
  Simulator sim(SimParams{}, robot, hall(), kStart, 1);
  sim.follow(legs(0.0, {{0, 0, 2}, {12, 0, 2}}, 2.0, 2.0));
  sim.advanceTo(3.0);
  const RobotState moving = sim.trueState();
  ASSERT_NEAR(moving.velocity.x(), 2.0, 0.1);
  sim.follow({});
  sim.advanceTo(5.0);
  const RobotState stopped = sim.trueState();
  EXPECT_LT(stopped.velocity.norm(), 0.05);
  EXPECT_LT((stopped.pose.position - moving.pose.position).norm(), brakingDistance(robot, 2.0));
  sim.advanceTo(9.0);
  EXPECT_LT((sim.trueState().pose.position - stopped.pose.position).norm(), 0.1);
}

/// How far the tilted body reaches above or below `height_m` until `until_s`.
double verticalReach(Simulator& sim, double height_m, double until_s) {
  const Vector3d half = 0.5 * sim.bodySize();
  double reach = 0.0;
  while (sim.time() < until_s) {
    sim.advanceTo(sim.time() + 0.01);
    const RobotState state = sim.trueState();
    const Eigen::RowVector3d up = state.orientation.toRotationMatrix().row(2);
    const double body = up.cwiseAbs().dot(half);
    reach = std::max(reach, std::abs(state.pose.position.z() - height_m) + body);
  }
  return reach;
}

/// A robot that starts or brakes tilts. At full speed its body stays within its box and the room
/// to tilt above and below it: it does not touch the floor right below. At the speed of narrow
/// places it hardly needs that room.
TEST(Simulator, TiltedBodyStaysWithinWhatIsKeptClear) {
  const std::string config = std::string(SPELUNK_SOURCE_DIR) + "/config";
  ParamTree tree;
  tree.addYamlFile(config + "/robots/aerial.yaml");
  RobotModel robot = loadRobot(tree, "aerial", config);
  robot.tilt_room_m = 0.15;
  constexpr double kHardly = 0.3;
  const double box_m = 0.5 * robot.box_m.z();
  for (const double yaw : {0.0, 0.25 * M_PI})
    for (const auto& [speed, kept_clear_m] :
         {std::pair{robot.speed_max_mps, box_m + robot.tilt_room_m},
          std::pair{narrowSpeed(robot), box_m + kHardly * robot.tilt_room_m}}) {
      Simulator sim(SimParams{}, robot, hall(), {kStart.position, yaw}, 1);
      Trajectory line = legs(0.0, {{0, 0, 2}, {12, 0, 2}}, speed, robot.acceleration_max_mps2);
      for (TrajectoryPoint& point : line) point.pose.yaw = yaw;
      sim.follow(line);
      EXPECT_LE(verticalReach(sim, 2.0, 3.0), kept_clear_m) << "yaw " << yaw << ", " << speed;
      sim.follow({});
      EXPECT_LE(verticalReach(sim, 2.0, 5.0), kept_clear_m) << "yaw " << yaw << ", " << speed;
    }
}

TEST(Simulator, FarReferenceIsFlownToWithoutTumbling) {
  Simulator sim(SimParams{}, RobotModel{}, hall(), kStart, 1);
  TrajectoryPoint target;
  target.pose.position = {12.0, 9.0, 4.0};
  target.pose.yaw = 3.0;
  const Flight flight = fly(sim, {target}, 15.0);
  EXPECT_LT(flight.worst_tilt_rad, 1.0);
  EXPECT_LT((sim.trueState().pose.position - target.pose.position).norm(), 0.05);
  EXPECT_EQ(sim.collisions().episodes, 0);
}

TEST(Simulator, CountsAScrapeAndRecoversFromIt) {
  Simulator sim(SimParams{}, RobotModel{}, hall(), {{0.0, 13.0, 2.0}, 0.0}, 1);
  fly(sim, legs(0.0, {{0, 13.0, 2}, {5, 14.8, 2}, {10, 13.0, 2}}, 2.0, 2.0), 3.0);
  EXPECT_GE(sim.collisions().episodes, 1);
  EXPECT_GT(sim.collisions().seconds, 0.0);
  const CollisionCount before = sim.collisions();
  const Flight home = fly(sim, legs(sim.time(), {{10, 13, 2}, {10, 0, 2}}, 2.0, 2.0), 1.0);
  EXPECT_LT(home.rms_error_m, 0.1);
  EXPECT_LT((sim.trueState().pose.position - Vector3d(10, 0, 2)).norm(), 0.05);
  EXPECT_EQ(sim.collisions().episodes, before.episodes);
}

TEST(Simulator, PillarStopsTheRobot) {
  Simulator sim(SimParams{}, RobotModel{}, test::corridorWithPillar(20.0F, 4.0F),
                {{2.0, 0.0, 1.5}, 0.0}, 1);
  fly(sim, legs(0.0, {{2, 0, 1.5}, {18, 0, 1.5}}, 2.0, 2.0), 1.0);
  EXPECT_GE(sim.collisions().episodes, 1);
  EXPECT_LT(sim.trueState().pose.position.x(), 10.0);
}

TEST(Simulator, ScansFallDueAtTheSensorsRate) {
  RobotModel robot;
  SensorModel slow;
  slow.name = "slow";
  slow.columns = 36;
  slow.rate_hz = 3.0;
  SensorModel fast = slow;
  fast.name = "fast";
  fast.rate_hz = 10.0;
  robot.sensor_models = {fast, slow};
  Simulator sim(SimParams{}, robot, hall(), kStart, 1);
  std::vector<double> fast_s;
  std::vector<double> slow_s;
  double last_s = 0.0;
  for (const double until : {0.0, 0.05, 0.051, 0.5, 1.0})
    for (const SimulatedScan& scan : sim.advanceTo(until)) {
      (scan.scan.sensor == "fast" ? fast_s : slow_s).push_back(scan.scan.stamp_s);
      EXPECT_GE(scan.scan.stamp_s, last_s);
      EXPECT_LE(scan.scan.stamp_s, until + 1e-9);
      last_s = scan.scan.stamp_s;
    }
  ASSERT_EQ(fast_s.size(), 11U);
  for (std::size_t k = 0; k < fast_s.size(); ++k)
    EXPECT_NEAR(fast_s[k], 0.1 * static_cast<double>(k), 1e-9);
  ASSERT_EQ(slow_s.size(), 4U);
  for (std::size_t k = 0; k < slow_s.size(); ++k)
    EXPECT_NEAR(slow_s[k], static_cast<double>(k) / 3.0, 0.0026);
}

TEST(Simulator, MappedScansAreTheSameWhetherTheOthersAreCastOrNot) {
  SimParams params;
  params.odometry_noise_m = 0.01;
  params.dust_returns = 0.02;
  RobotModel robot;
  SensorModel lidar;
  lidar.columns = 36;
  lidar.dropout_probability = 0.1;
  lidar.mapping_period_s = 0.3;
  robot.sensor_models = {lidar};
  Simulator all(params, robot, hall(), kStart, 3);
  Simulator mapped(params, robot, hall(), kStart, 3);
  mapped.castOnlyMappedScans();
  const auto all_scans = all.advanceTo(1.0);
  const auto mapped_scans = mapped.advanceTo(1.0);
  ASSERT_EQ(all_scans.size(), 11U);
  ASSERT_EQ(mapped_scans.size(), 4U);
  for (std::size_t k = 0; k < mapped_scans.size(); ++k) {
    EXPECT_EQ(mapped_scans[k].scan.stamp_s, all_scans[3 * k].scan.stamp_s);
    EXPECT_EQ(mapped_scans[k].scan.points, all_scans[3 * k].scan.points);
    EXPECT_EQ(mapped_scans[k].scan.T_world_sensor.matrix(),
              all_scans[3 * k].scan.T_world_sensor.matrix());
  }
}

TEST(Simulator, DriftMovesTheRobotNotItsBelief) {
  SimParams params;
  params.odometry_drift = 0.05;
  Simulator sim(params, RobotModel{}, hall(), kStart, 5);
  sim.follow(legs(0.0, {{0, 0, 2}, {10, 0, 2}}, 2.0, 2.0));
  sim.advanceTo(9.0);
  EXPECT_LT((sim.odometry().pose.position - Vector3d(10, 0, 2)).norm(), 0.1);
  const double off = (sim.trueState().pose.position - Vector3d(10, 0, 2)).norm();
  EXPECT_GT(off, 0.01);
  EXPECT_LT(off, 1.0);
}

TEST(Simulator, EmptyBatteryEndsTheFlight) {
  SimParams params;
  params.battery_wh = 0.2;
  Simulator sim(params, RobotModel{}, hall(), kStart, 1);
  sim.advanceTo(1.0);
  EXPECT_GT(sim.battery().fraction, 0.0);
  sim.advanceTo(6.0);
  EXPECT_EQ(sim.battery().fraction, 0.0);
  EXPECT_LT(sim.trueState().pose.position.z(), 0.5);
  EXPECT_GE(sim.collisions().episodes, 1);
}

std::string bitsOf(const RobotState& state) {
  std::string bits;
  const auto append = [&bits](const double* values, std::size_t count) {
    bits.append(reinterpret_cast<const char*>(values), count * sizeof(double));
  };
  append(state.pose.position.data(), 3);
  append(state.orientation.coeffs().data(), 4);
  append(state.velocity.data(), 3);
  append(&state.yaw_rate, 1);
  return bits;
}

/// Everything a run shows, scans included; the scrape on the way is part of it.
std::string flightBits(std::uint64_t seed, double period_s) {
  SimParams params;
  params.odometry_drift = 0.01;
  params.odometry_noise_m = 0.01;
  params.dust_returns = 0.02;
  RobotModel robot;
  SensorModel lidar;
  lidar.columns = 180;
  robot.sensor_models = {lidar};
  Simulator sim(params, robot, hall(), {{0.0, 13.0, 2.0}, 0.0}, seed);
  sim.follow(legs(0.0, {{0, 13.0, 2}, {5, 14.8, 2}, {10, 13.0, 2}}, 2.0, 2.0));
  std::string bits;
  for (int k = 1; k * period_s <= 8.0 + 1e-9; ++k)
    for (const SimulatedScan& scan : sim.advanceTo(k * period_s))
      bits.append(reinterpret_cast<const char*>(scan.scan.points.data()),
                  scan.scan.points.size() * sizeof(Eigen::Vector3f));
  EXPECT_GE(sim.collisions().episodes, 1);
  return bits + bitsOf(sim.trueState()) + bitsOf(sim.odometry());
}

TEST(Simulator, SameSeedSameBitsHoweverItIsAdvanced) {
  const std::string once = flightBits(3, 0.1);
  EXPECT_TRUE(once == flightBits(3, 0.1));
  EXPECT_TRUE(once == flightBits(3, 0.5));
  EXPECT_FALSE(once == flightBits(4, 0.1));
}

std::string errorOf(const SimParams& params, const Pose& start) {
  try {
    const Simulator sim(params, RobotModel{}, hall(), start, 1);
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

TEST(Simulator, NamesAnImpossibleStart) {
  const std::string in_floor = errorOf({}, {{1.0, 2.0, 0.1}, 0.0});
  EXPECT_NE(in_floor.find("in collision"), std::string::npos) << in_floor;
  EXPECT_NE(in_floor.find("clearance 0.1"), std::string::npos) << in_floor;
  EXPECT_NE(in_floor.find("--start"), std::string::npos) << in_floor;
  const std::string outside = errorOf({}, {{100.0, 2.0, 1.0}, 0.0});
  EXPECT_NE(outside.find("outside"), std::string::npos) << outside;
  EXPECT_NE(errorOf({}, {{NAN, 2.0, 1.0}, 0.0}).find("not finite"), std::string::npos);
}

TEST(Simulator, NamesImpossibleParameters) {
  SimParams params;
  params.rotors = 5;
  params.inertia_kgm2 = {0.01, 0.01, 0.1};
  const std::string error = errorOf(params, kStart);
  EXPECT_NE(error.find("sim.rotors"), std::string::npos) << error;
  EXPECT_NE(error.find("sim.inertia_kgm2"), std::string::npos) << error;
}

TEST(Simulator, ShippedParametersAreTheDefaults) {
  ParamTree tree;
  tree.addYamlFile(std::string(SPELUNK_SOURCE_DIR) + "/config/sim.yaml");
  SimParams params;
  tree.read("sim", params);
  tree.requireClean();
  const auto shipped = describe("sim", params);
  const auto defaults = describe("sim", SimParams{});
  ASSERT_EQ(shipped.size(), defaults.size());
  for (std::size_t k = 0; k < shipped.size(); ++k) {
    EXPECT_EQ(shipped[k].value, defaults[k].value) << shipped[k].name;
    const bool follows_from_the_box = shipped[k].name == "sim.body_m";
    EXPECT_EQ(tree.has(shipped[k].name), !follows_from_the_box) << shipped[k].name;
  }
}

TEST(Simulator, RefusesBrokenTrajectories) {
  Simulator sim(SimParams{}, RobotModel{}, hall(), kStart, 1);
  TrajectoryPoint point;
  EXPECT_THROW(sim.follow({point, point}), Precondition);
  point.pose.position.x() = NAN;
  EXPECT_THROW(sim.follow({point}), Precondition);
}

TEST(SimParams, BodyMustFitIntoTheBoxThatKeepsItClear) {
  SimParams params;
  RobotModel robot;
  EXPECT_TRUE(params.problemsFor(robot).empty());
  params.body_m.z() = 0.6;
  ASSERT_EQ(params.problemsFor(robot).size(), 1U);
  EXPECT_NE(params.problemsFor(robot).front().find("robot.box_m = [1.1, 1.1, 0.4]"),
            std::string::npos);
  robot.kind = "legged";
  robot.box_m = {1.2, 0.85, 0.7};
  robot.ride_height_m = params.walker.stand_height_m;
  EXPECT_TRUE(params.problemsFor(robot).empty());
  robot.ride_height_m += 0.2;
  EXPECT_EQ(params.problemsFor(robot).size(), 1U);
}

}  // namespace
}  // namespace spelunk::sim
