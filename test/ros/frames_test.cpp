#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "spelunk/mission/mission_store.h"
#include "spelunk/ros/frame_names.h"
#include "spelunk/ros/mission_core.h"
#include "spelunk/ros/sender_watch.h"
#include "support/temporary_folder.h"

namespace spelunk::bridge {
namespace {

const Eigen::Vector3d kUtm(467000.0, 5420000.0, 300.0);

MissionCore coreOfAerial() {
  return {
      mission::MissionParams(), RobotModel(), map::MapParams(), terrain::TerrainParams(), 1, 900.0};
}

TEST(FrameNames, PrefixIsJoinedByOneSlashAndTakenOffAgain) {
  EXPECT_EQ(prefixed("robot_1", "base_link"), "robot_1/base_link");
  EXPECT_EQ(prefixed("/robot_1/", "base_link"), "robot_1/base_link");
  EXPECT_EQ(prefixed("", "base_link"), "base_link");
  EXPECT_EQ(withoutPrefix("robot_1", "robot_1/lidar_16"), "lidar_16");
  EXPECT_EQ(withoutPrefix("robot_1", "robot_12/lidar_16"), "robot_12/lidar_16");
  EXPECT_EQ(withoutPrefix("", "lidar_16"), "lidar_16");
}

TEST(SenderWatch, TellsTwoThatTakeTurnsOnce) {
  SenderWatch watch;
  int told = 0;
  for (int k = 0; k < 100; ++k) {
    const auto both = watch.heard("/clock", k % 2 == 0 ? "/b" : "/a");
    if (!both) continue;
    ++told;
    EXPECT_EQ(both->first, "/a");
    EXPECT_EQ(both->second, "/b");
  }
  EXPECT_EQ(told, 1);
}

TEST(SenderWatch, LetsANodeBeRestartedUnderAnotherName) {
  SenderWatch watch;
  for (const char* name : {"/sim_1", "/sim_2", "/sim_3"})
    for (int k = 0; k < 50; ++k) EXPECT_FALSE(watch.heard("frame base_link", name));
}

TEST(SenderWatch, KeepsThingsApart) {
  SenderWatch watch;
  for (int k = 0; k < 50; ++k) {
    EXPECT_FALSE(watch.heard("frame robot_1/base_link", "/robot_1/sim_node"));
    EXPECT_FALSE(watch.heard("frame robot_2/base_link", "/robot_2/sim_node"));
  }
}

TEST(MissionCore, BoundsAndZonesOfBeforeTheFirstPoseAreTakenAlong) {
  MissionCore core = coreOfAerial();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const AxisAlignedBox box{{466950.0, 5419990.0, -kInfinity}, {467050.0, 5420010.0, 310.0}};
  ASSERT_TRUE(core.mission.setBounds(core.frame.toLocal(box)).accepted);
  const NoGoZone shaft{
      "shaft", {{467020.0, 5420000.0}, {467021.0, 5420000.0}, {467021.0, 5420001.0}}, 290.0, 320.0};
  ASSERT_TRUE(core.mission.setZones({core.frame.toLocal(shaft)}).accepted);
  const LocalFrame frame = frameAt(core, kUtm + Eigen::Vector3d(3.0, -2.0, 1.5));
  EXPECT_EQ(frame.origin(), kUtm);
  EXPECT_EQ(core.mission.bounds().min, Eigen::Vector3d(-50.0, -10.0, -kInfinity));
  EXPECT_EQ(core.mission.bounds().max, Eigen::Vector3d(50.0, 10.0, 10.0));
  ASSERT_EQ(core.mission.zones().size(), 1U);
  EXPECT_EQ(core.mission.zones()[0].polygon[1], Eigen::Vector2d(21.0, 0.0));
  EXPECT_EQ(core.mission.zones()[0].z_max, 20.0);
}

TEST(MissionCore, FrameStaysWhereTheFirstPosePutIt) {
  MissionCore core = coreOfAerial();
  EXPECT_TRUE(frameAt(core, {10.0, 20.0, 1.0}).isCallers());
  EXPECT_TRUE(frameAt(core, kUtm).isCallers());
}

/// A robot that stands in the middle of what it sees, has been told to explore, and holds because
/// its planner found nothing the first time.
void holdWhileExploring(mission::Mission& mission) {
  constexpr double kRadius_m = 5.0;
  constexpr int kRays = 720;
  double now_s = 0.0;
  for (int k = 1; k <= 5; ++k) {
    now_s = 0.1 * k;
    RobotState state;
    state.stamp_s = now_s;
    Scan scan;
    scan.stamp_s = now_s;
    scan.sensor = "lidar";
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2.0 * M_PI * ray / kRays;
      scan.points.emplace_back(kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), 0.0);
    }
    mission.onOdometry(state);
    (void)mission.onScan(scan);
    (void)mission.tick(now_s);
  }
  ASSERT_TRUE(mission.start().accepted) << mission.status().reason;
  (void)mission.tick(now_s);
  const auto job = mission.takeJob();
  ASSERT_TRUE(job);
  mission::PlanOutcome nothing;
  nothing.number = job->number;
  mission.take(nothing, now_s);
  ASSERT_EQ(mission.status().state, mission::MissionState::kHold);
}

TEST(MissionCore, AMissionThatHoldsToPlanAnewIsNotReplacedByASavedOne) {
  const test::TemporaryFolder folder;
  mission::MissionRecord record;
  record.frame = LocalFrame(kUtm);
  mission::writeRecord(folder.at("saved"), record);
  MissionCore core = coreOfAerial();
  (void)frameAt(core, Eigen::Vector3d::Zero());
  holdWhileExploring(core.mission);
  planners::PlannerGraph graph;
  const mission::Answer answer = load(core, folder.at("saved"), graph);
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.reason, "load: pause the mission first");
  EXPECT_TRUE(core.frame.isCallers());
}

}  // namespace
}  // namespace spelunk::bridge
