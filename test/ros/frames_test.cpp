#include <gtest/gtest.h>

#include <limits>

#include "spelunk/ros/frame_names.h"
#include "spelunk/ros/mission_core.h"
#include "spelunk/ros/sender_watch.h"

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

}  // namespace
}  // namespace spelunk::bridge
