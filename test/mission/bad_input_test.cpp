#include <gtest/gtest.h>

#include <limits>

#include "support/scripted_flight.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;
using test::ScriptedFlight;
using test::ScriptedPlanner;

const Pose kStart{{3.0, 2.5, 2.5}, 0.0};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    setLogSink([this](LogLevel level, const std::string& text) {
      if (level != LogLevel::kInfo) warnings_.push_back(text);
    });
    planner_.on_plan = [](const planners::PlanRequest& request) {
      Path path{request.pose, {{request.pose.position.x() + 6.0, 2.5, 2.5}, 0.0}};
      return ScriptedPlanner::path(path, PathKind::kLocal);
    };
  }
  void TearDown() override { setLogSink({}); }

  ScriptedPlanner planner_;
  std::vector<std::string> warnings_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(BadInput, StartWithoutOdometryIsRefused) {
  Mission mission({}, test::smallRobot(), test::coarseMap(), 1);
  const Answer answer = mission.start();
  EXPECT_FALSE(answer.accepted);
  EXPECT_TRUE(contains(answer.reason, "odometry"));
}

TEST_F(BadInput, BoundsThatExcludeTheRobotAreRefused) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  const Answer answer = flight.mission().setBounds({{10.0, 0.0, 0.0}, {20.0, 5.0, 5.0}});
  EXPECT_FALSE(answer.accepted);
  EXPECT_TRUE(contains(answer.reason, "exclude the robot"));
  EXPECT_TRUE(std::isinf(flight.mission().bounds().max.x()));
}

TEST_F(BadInput, EmptyBoundsAreRefused) {
  Mission mission({}, test::smallRobot(), test::coarseMap(), 1);
  EXPECT_FALSE(mission.setBounds({{1.0, 0.0, 0.0}, {0.0, 1.0, 1.0}}).accepted);
  EXPECT_FALSE(mission.setBounds({{kNan, 0.0, 0.0}, {1.0, 1.0, 1.0}}).accepted);
}

TEST_F(BadInput, ZonesWithFaultsAreRefusedByName) {
  Mission mission({}, test::smallRobot(), test::coarseMap(), 1);
  NoGoZone zone;
  zone.name = "sump";
  zone.polygon = {{0.0, 0.0}, {1.0, 0.0}};
  EXPECT_TRUE(contains(mission.setZones({zone}).reason, "sump"));
  zone.polygon.emplace_back(1.0, 1.0);
  zone.z_min = 2.0;
  zone.z_max = 1.0;
  EXPECT_FALSE(mission.setZones({zone}).accepted);
  EXPECT_TRUE(mission.zones().empty());
}

TEST_F(BadInput, StartInsideZoneIsRefused) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  NoGoZone zone;
  zone.name = "sump";
  zone.polygon = {{0.0, 0.0}, {5.0, 0.0}, {5.0, 5.0}, {0.0, 5.0}};
  ASSERT_TRUE(flight.mission().setZones({zone}).accepted);
  const Answer answer = flight.start();
  EXPECT_FALSE(answer.accepted);
  EXPECT_TRUE(contains(answer.reason, "sump"));
}

TEST_F(BadInput, StartInCollisionIsRefused) {
  Mission mission({}, test::smallRobot(), test::coarseMap(), 1);
  RobotState state;
  state.pose = kStart;
  Scan scan;
  scan.T_world_sensor.translation() = kStart.position - Eigen::Vector3d(3.0, 0.0, 0.0);
  scan.points.assign(1, Eigen::Vector3f(3.0F, 0.0F, 0.0F));
  mission.onScan(scan);  // no odometry yet: nothing tells the robot's own body apart
  mission.onOdometry(state);
  const Answer answer = mission.start();
  EXPECT_FALSE(answer.accepted);
  for (const char* part : {"1 occupied voxels", "[0.4, 0.4, 0.2] m", "(3.0, 2.5, 2.5)",
                           "nearest at", "move the robot", "robot.box_m"})
    EXPECT_TRUE(contains(answer.reason, part)) << part << " in " << answer.reason;
  mission.noteInputs({"", "returns 0.3 m from the sensor are its own", ""});
  EXPECT_TRUE(contains(mission.start().reason, "returns 0.3 m from the sensor are its own"));
}

TEST_F(BadInput, WhatTheOwnerFindsWrongWithInputsRefusesTheStartAndHoldsTheRobot) {
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  const std::string problem = "waits for point clouds on '/points': none since 4 s";
  flight.mission().noteInputs({problem, "", ""});
  EXPECT_EQ(flight.mission().start().reason, problem);
  flight.mission().noteInputs({});
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(2.0);
  ASSERT_NE(flight.mission().status().state, MissionState::kHold);
  flight.mission().noteInputs({problem, "", ""});
  flight.flyFor(1.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_EQ(flight.mission().status().reason, problem);
  flight.mission().noteInputs({});
  flight.flyFor(8.0);
  EXPECT_NE(flight.mission().status().state, MissionState::kHold) << "it is over";
}

TEST_F(BadInput, AFlawOfInputsIsSaidWhereTheMissionEndsAsExplored) {
  planner_.on_plan = nullptr;  // Nothing to gain.
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.mission().noteInputs({"", "", "returns 0.5 m from the sensor move with the robot"});
  flight.flyFor(20.0);
  EXPECT_TRUE(contains(flight.mission().status().end_reason,
                       "explored: the script says so; but returns 0.5 m from the sensor move"))
      << flight.mission().status().end_reason;
}

TEST_F(BadInput, ADoubtAboutInputsExplainsWhyThereIsNoPlan) {
  planner_.on_plan = [](const planners::PlanRequest&) {
    return ScriptedPlanner::none(planners::PlanStatus::kStartBlocked);
  };
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.mission().noteInputs({"", "returns 0.5 m from the sensor are its own", ""});
  flight.flyFor(20.0);
  EXPECT_TRUE(contains(flight.mission().status().end_reason, "returns 0.5 m from the sensor"))
      << flight.mission().status().end_reason;
}

TEST_F(BadInput, OdometryWithNanHoldsTheRobotAndMissionGoesOnAfter) {
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(2.0);
  RobotState bad = flight.state();
  bad.pose.position.x() = kNan;
  flight.mission().onOdometry(bad);
  const auto command = flight.mission().tick(flight.now());
  ASSERT_TRUE(command);
  EXPECT_TRUE(command->path.empty());
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_TRUE(contains(flight.mission().status().reason, "NaN"));
  flight.flyFor(8.0);
  EXPECT_NE(flight.mission().status().state, MissionState::kHold);
}

TEST_F(BadInput, JumpOfMetresHoldsTheRobot) {
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(2.0);
  RobotState bad = flight.state();
  bad.pose.position.y() += 7.0;
  flight.mission().onOdometry(bad);
  flight.mission().tick(flight.now());
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_TRUE(contains(flight.mission().status().reason, "jumped"));
}

TEST_F(BadInput, SilentOdometryAndScansHoldTheRobotAndSaySo) {
  for (const char* which : {"odometry", "scan"}) {
    ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
    ASSERT_TRUE(flight.start().accepted);
    flight.flyFor(2.0);
    if (which[0] == 'o') flight.muteOdometry();
    if (which[0] == 's') flight.muteScans();
    flight.flyFor(3.0);
    EXPECT_EQ(flight.mission().status().state, MissionState::kHold) << which;
    EXPECT_TRUE(contains(flight.mission().status().reason, which))
        << flight.mission().status().reason;
  }
}

/// Of sensors that are slow, or whose scans are seldom mapped.
TEST_F(BadInput, SlowSensorsDoNotHoldTheRobotForEver) {
  for (const bool is_slow : {true, false}) {
    RobotModel robot = test::smallRobot();
    if (is_slow) robot.sensor_models[0].rate_hz = 0.4;
    if (!is_slow) robot.sensor_models[0].mapping_period_s = 4.0;
    ScriptedFlight flight(test::corridorWorld(60.0), kStart, planner_, {}, 1, robot);
    if (is_slow) flight.scanEvery(2.5);
    ASSERT_TRUE(flight.start().accepted);
    flight.flyFor(40.0);
    EXPECT_GT(flight.mission().status().distance_m, 5.0) << flight.mission().status().reason;
  }
}

TEST_F(BadInput, OddScansAreCountedOutNeverThrown) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  Scan scan;
  scan.stamp_s = flight.now();
  EXPECT_EQ(flight.mission().onScan(scan).points, 0);
  scan.points.assign(3, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  scan.T_world_sensor.translation() = kStart.position;
  const auto update = flight.mission().onScan(scan);
  EXPECT_EQ(update.dropped_not_finite, 3);
  scan.T_world_sensor.translation().x() = kNan;
  EXPECT_EQ(flight.mission().onScan(scan).points, 0);
  scan.T_world_sensor.translation() = kStart.position;
  scan.stamp_s = flight.now() + 100.0;
  EXPECT_EQ(flight.mission().onScan(scan).points, 0);
}

TEST_F(BadInput, SameMessageIsSaidAtMostOnceInFiveSeconds) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  Scan empty;
  for (int k = 0; k < 100; ++k) {
    flight.mission().onScan(empty);
    flight.mission().tick(flight.now() + 0.1 * k);
  }
  EXPECT_LE(std::count_if(warnings_.begin(), warnings_.end(),
                          [](const std::string& text) { return contains(text, "without points"); }),
            3);
}

TEST_F(BadInput, EnduranceThatIsNoNumberIsNotUsed) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.mission().onRemaining(500.0);
  flight.mission().onRemaining(kNan);
  flight.mission().onRemaining(-3.0);
  flight.mission().tick(flight.now());
  EXPECT_EQ(flight.mission().status().remaining_s, 500.0);
}

TEST_F(BadInput, LoadFromNowhereNamesThePathAndKeepsTheMap) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  ASSERT_TRUE(flight.mission().pause().accepted);
  const auto before = flight.mission().map().freeze()->freeVoxels();
  const Answer answer = flight.mission().load("/nonexistent/mission", nullptr);
  EXPECT_FALSE(answer.accepted);
  EXPECT_TRUE(contains(answer.reason, "/nonexistent/mission"));
  EXPECT_EQ(flight.mission().map().freeze()->freeVoxels(), before);
}

}  // namespace
}  // namespace spelunk::mission
