#include "spelunk/sim/walker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "spelunk/common/contract.h"
#include "support/meshes.h"
#include "support/terrain.h"
#include "support/walking.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::Walked;

const Pose kStart{{0.0, 0.0, 1.0}, 0.0};
const std::vector<Vector2d> kToFour{{0, 0}, {4, 0}};

WorldMesh flatGround() { return test::profile({{-20, 0}, {120, 0}}, 40.0F); }

Walked walkOn(const WorldMesh& mesh, double speed_mps, double distance_m,
              const SimParams& params = {}) {
  Simulator sim(params, test::walkerModel(speed_mps), mesh, kStart, 1);
  return test::walk(sim, {{0, 0}, {distance_m, 0}}, speed_mps);
}

void expectArrival(const Walked& walked, double distance_m) {
  EXPECT_EQ(walked.count.falls, 0);
  EXPECT_EQ(walked.count.slips, 0);
  EXPECT_EQ(walked.count.trips, 0);
  EXPECT_EQ(walked.trunk_contacts, 0);
  EXPECT_NEAR(walked.end.x(), distance_m, 0.15);
  EXPECT_LT(walked.worst_off_m, 0.15);
}

class AnyGait : public testing::TestWithParam<const char*> {
 protected:
  static SimParams params() {
    SimParams params;
    params.walker.gait = GetParam();
    if (params.walker.gait == "walk") {
      params.walker.gait_period_s = 0.9;
      params.walker.duty_factor = 0.78;
    }
    return params;
  }
};
INSTANTIATE_TEST_SUITE_P(Walker, AnyGait, testing::Values("trot", "walk"));

class AnySpeed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Walker, AnySpeed, testing::Values(0.3, 0.5, 0.8));

TEST_P(AnyGait, WalksASquareAndTurnsAtItsCorners) {
  Simulator sim(params(), test::walkerModel(), flatGround(), kStart, 1);
  const Walked walked = test::walk(sim, {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}}, 0.5);
  EXPECT_EQ(walked.count.falls, 0);
  EXPECT_EQ(walked.trunk_contacts, 0);
  EXPECT_LT(walked.worst_off_m, 0.2);
  EXPECT_LT(walked.worst_tilt_deg, 5.0);
  EXPECT_LT(walked.end.head<2>().norm(), 0.15);
  EXPECT_NEAR(walked.end_yaw, -M_PI / 2, 0.15);
  EXPECT_NEAR(walked.lowest_z, 0.5, 0.03);
}

TEST_P(AnyGait, GoesUpAndDownARampAndStairs) {
  expectArrival(walkOn(test::ramp(20.0F, 3.0F), 0.5, 14.0, params()), 14.0);
  expectArrival(walkOn(test::stairs(0.15F, 0.35F, 4), 0.5, 10.0, params()), 10.0);
}

TEST_P(AnySpeed, WalksSixtyMetresOfRoughGround) {
  const Walked walked = walkOn(test::roughGround(72.0F, 4.0F, 0.3F, 3), GetParam(), 60.0);
  expectArrival(walked, 60.0);
  EXPECT_GT(walked.highest_z - walked.lowest_z, 0.1) << "the ground was not rough";
}

TEST_P(AnySpeed, StaysOnItsFeetInRubble) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const WorldMesh rubble = test::rubble(0.2, seed);
    Simulator sim({}, test::walkerModel(GetParam()), rubble, kStart, 1);
    const Walked walked = test::walk(sim, {{0, 0}, {8, 3}, {16, -3}, {24, 3}}, GetParam());
    EXPECT_EQ(walked.count.falls, 0) << "seed " << seed << " at " << walked.end.transpose();
    EXPECT_NEAR((walked.end.head<2>() - Vector2d(24, 3)).norm(), 0.0, 0.2) << "seed " << seed;
  }
}

TEST_P(AnySpeed, StaysOnItsFeetAstrideABlock) {
  for (const float start : {1.5F, 1.6F, 1.7F, 1.8F, 1.9F, 2.0F, 2.1F, 2.2F}) {
    WorldMesh mesh = flatGround();
    test::addBox(mesh, {start, 0.0F, -0.3F}, {start + 1.2F, 3.0F, 0.23F});  // under the left feet
    const Walked walked = walkOn(mesh, GetParam(), 7.0);
    EXPECT_EQ(walked.count.falls, 0) << start;
    EXPECT_NEAR(walked.end.x(), 7.0, 0.2) << start;
  }
}

TEST_P(AnySpeed, ClimbsRampAndStairs) {
  const Walked ramp = walkOn(test::ramp(20.0F, 3.0F), GetParam(), 14.0);
  expectArrival(ramp, 14.0);
  EXPECT_NEAR(ramp.worst_tilt_deg, 20.0, 2.0) << "the trunk follows the slope";
  EXPECT_NEAR(ramp.highest_z, 3.0 * std::tan(20.0 * M_PI / 180.0) + 0.5, 0.05);
  const Walked stairs = walkOn(test::stairs(0.15F, 0.35F, 4), GetParam(), 10.0);
  expectArrival(stairs, 10.0);
  EXPECT_NEAR(stairs.highest_z, 0.6 + 0.5, 0.05);
}

TEST_P(AnySpeed, DoesNotPassWhatItCannot) {
  const Walked trench = walkOn(test::trench(0.5F, 3.0F), GetParam(), 8.0);
  EXPECT_EQ(trench.count.falls, 1);
  EXPECT_GE(trench.trunk_contacts, 1);
  EXPECT_LT(trench.end.x(), 5.0);
  const Walked step = walkOn(test::step(0.4F), GetParam(), 8.0);
  EXPECT_LT(step.end.x(), 3.0);
  EXPECT_GE(step.trunk_contacts, 1);
  const Walked slope = walkOn(test::ramp(45.0F, 3.0F), GetParam(), 8.0);
  EXPECT_LT(slope.end.x(), 4.0);
  EXPECT_GE(slope.trunk_contacts + slope.count.falls, 1);
}

TEST(Walker, StepsOverANarrowTrenchAndUpAndDownALowStep) {
  expectArrival(walkOn(test::trench(1.0F, 0.3F), 0.5, 7.0), 7.0);
  expectArrival(walkOn(test::step(0.2F), 0.5, 8.0), 8.0);
  expectArrival(walkOn(test::step(-0.15F), 0.5, 8.0), 8.0);
}

TEST(Walker, TripsOverWhatIsTooThinToBeSeen) {
  WorldMesh mesh = flatGround();
  for (int k = 0; k < 6; ++k) {  // upright sheets, 4 mm thick and as high as a shin
    const auto x = 1.0F + 0.37F * static_cast<float>(k);
    test::addBox(mesh, {x, -3.0F, -0.1F}, {x + 0.004F, 3.0F, 0.25F});
  }
  EXPECT_GT(walkOn(mesh, 0.5, 4.0).count.trips, 0);
}

TEST(Walker, FallsOffALedge) {
  const Walked walked = walkOn(test::step(-0.5F), 0.5, 8.0);
  EXPECT_EQ(walked.count.falls, 1);
}

TEST(Walker, LiesWhereItFell) {
  Simulator sim({}, test::walkerModel(), test::trench(0.5F, 3.0F), kStart, 1);
  test::walk(sim, {{0, 0}, {8, 0}}, 0.5);
  ASSERT_EQ(sim.walkerCount().falls, 1);
  const Vector3d before = sim.trueState().pose.position;
  for (const FootState& foot : sim.feet()) EXPECT_FALSE(foot.is_in_contact) << foot.name;
  test::walk(sim, {{before.x(), before.y()}, {before.x() - 4.0, before.y()}}, 0.5);
  EXPECT_LT((sim.trueState().pose.position - before).norm(), 0.1);
  EXPECT_EQ(sim.walkerCount().falls, 1);
}

TEST(Walker, SlipsOnASlipperyRamp) {
  SimParams params;
  params.walker.friction_coefficient = 0.25;
  const Walked walked = walkOn(test::ramp(20.0F, 3.0F), 0.5, 14.0, params);
  EXPECT_GE(walked.count.slips, 1);
  EXPECT_LT(walked.end.x(), 5.0);
}

TEST(Walker, StopsInBrakingDistanceAndStands) {
  const RobotModel robot = test::walkerModel();
  Simulator sim({}, robot, flatGround(), kStart, 1);
  sim.follow(test::walkAlong(kToFour, 0.5, 0.0));
  sim.advanceTo(5.0);
  const RobotState moving = sim.trueState();
  ASSERT_NEAR(moving.velocity.x(), 0.5, 0.1);
  sim.follow({});
  sim.advanceTo(9.0);
  const RobotState stopped = sim.trueState();
  EXPECT_LT((stopped.pose.position - moving.pose.position).norm(), brakingDistance(robot, 0.5));
  for (const FootState& foot : sim.feet()) EXPECT_TRUE(foot.is_in_contact) << foot.name;
  sim.advanceTo(14.0);
  EXPECT_LT((sim.trueState().pose.position - stopped.pose.position).norm(), 0.01);
}

TEST(Walker, TrajectoryWaitsForARobotThatIsHeldUp) {
  Simulator sim({}, test::walkerModel(), flatGround(), kStart, 1);
  const std::vector<Vector2d> corners{{0, 0}, {6, 0}, {6, 6}};
  sim.follow(test::walkAlong(corners, 1.2, 0.3));  // more than twice what it can
  double worst_off_m = 0.0;
  for (double t = 0.1; t < 40.0; t += 0.1) {
    sim.advanceTo(t);
    worst_off_m =
        std::max(worst_off_m, test::offLine(corners, sim.trueState().pose.position.head<2>()));
  }
  EXPECT_LT(worst_off_m, 0.45) << "it cut the corner";
  EXPECT_LT((sim.trueState().pose.position.head<2>() - Vector2d(6, 6)).norm(), 0.15);
}

TEST(Walker, DrivesAsCommandedUntilTheCommandLapses) {
  Simulator sim({}, test::walkerModel(), flatGround(), {{0, 0, 1}, 0.5}, 1);
  for (int k = 0; k < 40; ++k) {
    const DriveAnswer answer = sim.drive({0.3, 0.1, 0.2});
    EXPECT_TRUE(answer.warning.empty()) << answer.warning;
    sim.advanceTo(0.1 * (k + 1));
  }
  const RobotState moving = sim.trueState();
  const Vector3d in_base = moving.orientation.conjugate() * moving.velocity;
  EXPECT_NEAR(in_base.x(), 0.3, 0.08);
  EXPECT_NEAR(in_base.y(), 0.1, 0.08);
  EXPECT_NEAR(moving.pose.yaw, 0.5 + 0.2 * 4.0, 0.15);
  sim.advanceTo(7.0);
  const Vector3d stopped = sim.trueState().pose.position;
  EXPECT_LT((stopped - moving.pose.position).norm(), 0.5);
  sim.advanceTo(9.0);
  EXPECT_LT((sim.trueState().pose.position - stopped).norm(), 0.01);
}

TEST(Walker, ReducesDriveCommandsAboveItsLimitsAndSaysSo) {
  Simulator sim({}, test::walkerModel(0.5), flatGround(), kStart, 1);
  const DriveAnswer answer = sim.drive({-2.0, 1.0, 0.1});
  EXPECT_NEAR(answer.executed.forward_mps, -0.3, 1e-12);
  EXPECT_NEAR(answer.executed.sideways_mps, 0.2, 1e-12);
  EXPECT_NEAR(answer.executed.yaw_rate_radps, 0.1, 1e-12);
  EXPECT_NE(answer.warning.find("forward -2 to -0.3 m/s"), std::string::npos) << answer.warning;
  EXPECT_NE(answer.warning.find("sideways 1 to 0.2 m/s"), std::string::npos) << answer.warning;
  EXPECT_EQ(answer.warning.find("yaw"), std::string::npos) << answer.warning;
  EXPECT_EQ(sim.reducedDrives(), 1);
  EXPECT_THROW(sim.drive({NAN, 0.0, 0.0}), Precondition);
  EXPECT_EQ(sim.reducedDrives(), 1);
}

TEST(Walker, DriftMovesTheRobotNotItsBelief) {
  SimParams params;
  params.odometry_drift = 0.05;
  Simulator sim(params, test::walkerModel(), flatGround(), kStart, 5);
  const Walked walked = test::walk(sim, {{0, 0}, {10, 0}}, 0.5);
  EXPECT_LT((sim.odometry().pose.position.head<2>() - Vector2d(10, 0)).norm(), 0.15);
  EXPECT_GT((walked.end.head<2>() - Vector2d(10, 0)).norm(), 0.02);
}

TEST(Walker, SinksDownWithAnEmptyBattery) {
  SimParams params;
  params.battery_wh = 0.2;
  Simulator sim(params, test::walkerModel(), flatGround(), kStart, 1);
  sim.advanceTo(3.0);
  EXPECT_NEAR(sim.trueState().pose.position.z(), 0.5, 0.01);
  sim.advanceTo(8.0);
  EXPECT_EQ(sim.battery().fraction, 0.0);
  EXPECT_LT(sim.trueState().pose.position.z(), 0.2);
  EXPECT_EQ(sim.walkerCount().falls, 0);
}

TEST(Walker, FeetAndJointsAgreeWithTheGround) {
  Simulator sim({}, test::walkerModel(), test::roughGround(20.0F, 6.0F, 0.3F, 4), kStart, 1);
  sim.follow(test::walkAlong(kToFour, 0.5, 0.0));
  int standing = 0;
  for (double t = 0.5; t < 8.0; t += 0.5) {
    sim.advanceTo(t);
    const RobotState state = sim.trueState();
    for (const FootState& foot : sim.feet()) {
      if (!foot.is_in_contact) continue;
      const Vector3d at = state.pose.position + state.orientation * foot.position;
      EXPECT_LT(sim.scene().distanceTo(at, 1.0), 0.02) << foot.name << " at " << t;
      ++standing;
    }
    EXPECT_EQ(sim.joints().names.size(), 12U);
    EXPECT_EQ(sim.joints().angles.size(), 12U);
  }
  EXPECT_GE(standing, 30);
}

std::string bitsOf(std::uint64_t seed, double period_s) {
  SimParams params;
  params.odometry_drift = 0.01;
  params.odometry_noise_m = 0.01;
  Simulator sim(params, test::walkerModel(), test::roughGround(16.0F, 6.0F, 0.3F, 4), kStart, seed);
  sim.follow(test::walkAlong(kToFour, 0.5, 0.0));
  for (int k = 1; k * period_s <= 6.0 + 1e-9; ++k) sim.advanceTo(k * period_s);
  std::string bits(8 * 19, '\0');
  const RobotState state = sim.trueState();
  std::memcpy(bits.data(), state.pose.position.data(), 24);
  std::memcpy(bits.data() + 24, state.orientation.coeffs().data(), 32);
  std::memcpy(bits.data() + 56, sim.joints().angles.data(), 96);
  return bits;
}

TEST(Walker, SameSeedSameBitsHoweverItIsAdvanced) {
  const std::string once = bitsOf(3, 0.1);
  EXPECT_TRUE(once == bitsOf(3, 0.1));
  EXPECT_TRUE(once == bitsOf(3, 0.5));
  EXPECT_FALSE(once == bitsOf(4, 0.1));
}

std::string startError(const WorldMesh& mesh, const Pose& start, const WalkerParams& walker = {}) {
  SimParams params;
  params.walker = walker;
  try {
    const Simulator sim(params, test::walkerModel(), mesh, start, 1);
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "";
}

TEST(Walker, StandsOnTheGroundBelowItsStart) {
  const Simulator sim({}, test::walkerModel(), test::ramp(20.0F, 3.0F), {{4.5, 0, 1.9}, 0.0}, 1);
  const double ground = 1.5 * std::tan(20.0 * M_PI / 180.0);
  EXPECT_NEAR(sim.trueState().pose.position.z(), ground + 0.5, 0.02);
  EXPECT_NEAR((sim.trueState().orientation * Vector3d::UnitX()).z(), std::sin(20.0 * M_PI / 180.0),
              0.02);
}

TEST(Walker, NamesAnImpossibleStart) {
  const WorldMesh trench = test::trench(5.0F, 3.0F);
  EXPECT_NE(startError(trench, {{4.5, 0, 1.0}, 0.0}).find("no ground within 1.5 m"),
            std::string::npos);
  EXPECT_NE(startError(trench, {{2.9, 0, 1.0}, 0.0}).find("no ground under foot LF"),
            std::string::npos);
  const std::string steep = startError(test::ramp(40.0F, 4.0F), {{5.0, 0, 2.5}, 0.0});
  EXPECT_NE(steep.find("degrees, the limit is 30"), std::string::npos) << steep;
  const std::string low = startError(test::boxRoom({10, 10, 0.6F}), {{0, 0, 0.3}, 0.0});
  EXPECT_NE(low.find("in collision"), std::string::npos) << low;
  EXPECT_NE(low.find("walker.trunk_m"), std::string::npos) << low;
  EXPECT_NE(startError(trench, {{500, 0, 1.0}, 0.0}).find("outside"), std::string::npos);
}

TEST(Walker, NamesImpossibleParameters) {
  WalkerParams walker;
  walker.thigh_m = 0.1;
  walker.gait = "gallop";
  const std::string error = startError(flatGround(), kStart, walker);
  EXPECT_NE(error.find("walker.thigh_m"), std::string::npos) << error;
  EXPECT_NE(error.find("gallop"), std::string::npos) << error;
}

TEST(Walker, LiesDownAndStandsUpWithoutAFall) {
  Simulator sim(SimParams(), test::walkerModel(), flatGround(), kStart, 1);
  sim.advanceTo(1.0);
  const double standing_m = sim.trueState().pose.position.z();
  sim.take(Posture::kLie);
  sim.advanceTo(5.0);
  EXPECT_LT(sim.trueState().pose.position.z(), standing_m - 0.2);
  EXPECT_LT(sim.trueState().velocity.norm(), 0.05);
  sim.take(Posture::kStand);
  sim.advanceTo(9.0);
  EXPECT_NEAR(sim.trueState().pose.position.z(), standing_m, 0.02);
  EXPECT_EQ(sim.walkerCount().falls, 0);
  EXPECT_EQ(sim.collisions().episodes, 0);
}

}  // namespace
}  // namespace spelunk::sim
