#include <gtest/gtest.h>

#include "spelunk/mission/mission.h"
#include "spelunk/mission/mission_store.h"
#include "support/scans.h"
#include "support/scripted_flight.h"
#include "support/temporary_folder.h"

namespace spelunk::mission {
namespace {

constexpr double kRideHeight_m = 0.5;

RobotModel leggedRobot() {
  RobotModel robot = test::smallRobot();
  robot.kind = "legged";
  robot.box_lift_m = 0.25;
  robot.ride_height_m = kRideHeight_m;
  robot.speed_max_mps = 0.5;
  return robot;
}

RobotState standing(double x, double stamp_s, double roll_deg = 0.0) {
  RobotState state;
  state.stamp_s = stamp_s;
  state.pose = {{x, 0.0, kRideHeight_m}, 0.0};
  state.orientation = Eigen::AngleAxisd(roll_deg * M_PI / 180.0, Eigen::Vector3d::UnitX());
  return state;
}

class MissionOnFoot : public testing::Test {
 protected:
  void SetUp() override {
    setLogSink([](LogLevel, const std::string&) {});
  }

  /// Tells the mission for a while that the robot stands at `x`.
  void standFor(double seconds, double x, double roll_deg = 0.0) {
    for (const double end = now_ + seconds; now_ < end; now_ += 0.1) {
      mission_.onOdometry(standing(x, now_, roll_deg));
      mission_.onScan(floorAround(x));
      mission_.tick(now_);
    }
  }

  [[nodiscard]] Scan floorAround(double x) const {
    Scan scan;
    scan.stamp_s = now_ - late_s_;
    scan.T_world_sensor = Eigen::Translation3d(x, 0.0, 1.0) * Eigen::Quaterniond::Identity();
    for (double dx = -3.0; dx <= 3.0; dx += 0.05)
      for (double dy = -3.0; dy <= 3.0; dy += 0.05)
        scan.points.emplace_back(static_cast<float>(dx), static_cast<float>(dy), -1.0F);
    return scan;
  }

  Mission mission_{{}, leggedRobot(), test::coarseMap(), 1};
  double now_ = 0.0;
  double late_s_ = 0.0;
};

TEST(MappingPeriod, ScansThatFollowTooSoonDoNotEnterTheMap) {
  RobotModel robot = leggedRobot();
  robot.sensor_models.front().mapping_period_s = 0.2;
  Mission mission({}, robot, test::coarseMap(), 1);
  mission.onOdometry(standing(0.0, 0.0));
  const auto pointsOf = [&](const std::string& sensor, double stamp_s) {
    Scan scan;
    scan.sensor = sensor;
    scan.stamp_s = stamp_s;
    scan.points.emplace_back(2.0F, 0.0F, 0.0F);
    return mission.onScan(scan).points;
  };
  const std::string& name = robot.sensor_models.front().name;
  EXPECT_EQ(pointsOf(name, 0.0), 1);
  EXPECT_EQ(pointsOf(name, 0.1), 0);
  EXPECT_EQ(pointsOf("another sensor", 0.1), 1);
  EXPECT_EQ(pointsOf(name, 0.2), 1);
}

TEST_F(MissionOnFoot, StopsAndSaysSoAfterAFall) {
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.start().accepted) << mission_.status().reason;
  standFor(1.0, 0.0, 30.0);
  EXPECT_NE(mission_.status().state, MissionState::kEStop) << "a slope";
  standFor(0.2, 0.0, 70.0);
  EXPECT_NE(mission_.status().state, MissionState::kEStop) << "a stumble";
  standFor(0.5, 0.0, 0.0);
  standFor(0.6, 0.0, 70.0);
  EXPECT_EQ(mission_.status().state, MissionState::kEStop);
  EXPECT_NE(mission_.status().reason.find("fallen (tilted by 70 degrees)"), std::string::npos)
      << mission_.status().reason;
}

TEST_F(MissionOnFoot, StartsAgainOnlyOnItsFeet) {
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.start().accepted);
  standFor(1.0, 0.0, 85.0);
  const Answer lying = mission_.start();
  EXPECT_FALSE(lying.accepted);
  EXPECT_NE(lying.reason.find("on its side"), std::string::npos) << lying.reason;
  standFor(0.5, 0.0);
  EXPECT_TRUE(mission_.start().accepted) << mission_.status().reason;
}

TEST_F(MissionOnFoot, HoldsWhileScansComeInLate) {
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.start().accepted);
  standFor(1.0, 0.0);
  EXPECT_EQ(mission_.status().reason.find("late"), std::string::npos);
  late_s_ = 3.0;
  standFor(4.0, 0.0);
  EXPECT_NE(mission_.status().reason.find("scans come in 3.0 s late"), std::string::npos)
      << mission_.status().reason;
}

TEST_F(MissionOnFoot, ShowsPathsOfItsBase) {
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.start().accepted);
  for (double x = 0.0; x < 2.0; x += 0.1) standFor(0.1, x);
  standFor(0.6, 2.0);
  ASSERT_GT(mission_.trail().size(), 3U);
  for (const Pose& pose : mission_.trail()) EXPECT_NEAR(pose.position.z(), kRideHeight_m, 1e-9);
  ASSERT_GT(mission_.wayHome().size(), 1U);
  for (const Pose& pose : mission_.wayHome()) EXPECT_NEAR(pose.position.z(), kRideHeight_m, 1e-9);
}

TEST_F(MissionOnFoot, LoadedZonesStayTheRobotsOrPeoples) {
  const test::TemporaryFolder folder;
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.start().accepted);
  for (double x = 0.0; x < 4.0; x += 0.1) standFor(0.1, x);
  mission_.pause();
  ASSERT_TRUE(mission_.save(folder.at("saved"), {}).accepted);
  MissionRecord record = readRecord(folder.at("saved"));
  record.given_zones.push_back({"people's", {{9.0, 0.0}, {10.0, 0.0}, {10.0, 1.0}}, -1.0, 2.0});
  // Right on the trail: the robot noticed only when it had walked on.
  record.marked_zones.push_back({"robot's", {{1.8, -1.0}, {2.2, -1.0}, {2.2, 1.0}}, -1.0, 2.0});
  writeRecord(folder.at("saved"), record);

  Mission next({}, leggedRobot(), test::coarseMap(), 1);
  next.onOdometry(standing(4.0, 0.0));
  ASSERT_TRUE(next.load(folder.at("saved"), nullptr).accepted);
  ASSERT_EQ(next.zones().size(), 2U);
  EXPECT_EQ(next.status().zones_marked, 1);
  next.onOdometry(standing(4.0, 0.1));
  next.onScan(floorAround(4.0));
  next.tick(0.1);
  ASSERT_TRUE(next.home().accepted);
  const auto command = next.tick(0.2);
  ASSERT_TRUE(command) << next.status().reason;
  ASSERT_FALSE(command->path.empty()) << next.status().reason;
  EXPECT_LT(command->path.back().position.x(), 0.5);

  ASSERT_TRUE(next.setZones({}).accepted);
  ASSERT_EQ(next.zones().size(), 1U);
  EXPECT_EQ(next.zones()[0].name, "robot's");
}

TEST_F(MissionOnFoot, LiesDownAtAnEmergencyStopAndStandsUpBeforeItGoesOn) {
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.start().accepted) << mission_.status().reason;
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.emergencyStop().accepted);
  const auto lie = mission_.tick(now_);
  ASSERT_TRUE(lie);
  EXPECT_TRUE(lie->path.empty());
  EXPECT_EQ(lie->posture, Posture::kLie);
  ASSERT_TRUE(mission_.start().accepted) << mission_.status().reason;
  const auto stand = mission_.tick(now_);
  ASSERT_TRUE(stand);
  EXPECT_TRUE(stand->path.empty());
  EXPECT_EQ(stand->posture, Posture::kStand);
  standFor(2.0, 0.0);
  EXPECT_FALSE(mission_.takeJob()) << "still on its way up";
  standFor(3.0, 0.0);
  EXPECT_TRUE(mission_.takeJob());
}

TEST_F(MissionOnFoot, TakesNoHomeWhileItLies) {
  standFor(0.5, 0.0);
  ASSERT_TRUE(mission_.emergencyStop().accepted);
  const Answer lying = mission_.start();
  EXPECT_FALSE(lying.accepted);
  EXPECT_NE(lying.reason.find("stands up"), std::string::npos) << lying.reason;
  standFor(0.5, 0.0);
  EXPECT_TRUE(mission_.start().accepted) << mission_.status().reason;
}

}  // namespace
}  // namespace spelunk::mission
