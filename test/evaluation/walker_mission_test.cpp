#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/log.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/planners/factory.h"
#include "support/pit_room.h"

namespace spelunk::evaluation {
namespace {

constexpr std::uint64_t kSeed =
    2;  // its way leads over the pit; without a look at it the robot falls

enum class Ground { kVerified, kTakenOnTrust };

struct Walk {
  RunRecord record;
  std::vector<NoGoZone> zones;
};

/// The shipped walker with fewer rays.
Walk walkPitRoom(Ground ground, std::uint64_t seed, const Delays& delays = {}) {
  setLogSink([](LogLevel, const std::string&) {});
  mission::RunChoice choice;
  choice.share_dir = SPELUNK_SOURCE_DIR;
  choice.robot = "walker";
  choice.assignments = {"sensor.lidar_16.columns=900"};
  mission::RunConfig config = mission::loadRunConfig(choice);
  RunSetup setup;
  setup.robot = config.robot;
  setup.sim = sim::readSimParams(config.tree);
  setup.map = config.map;
  setup.mission = config.mission;
  setup.mission.verify_ground = ground == Ground::kVerified;
  setup.terrain = config.terrain;
  setup.start = {{-2.0, 0.0, 0.6}, 0.0};
  setup.seed = seed;
  setup.delays = delays;
  setup.time_limit_s = 300.0;
  const auto planner =
      planners::makePlanner("gbplanner", config.tree, setup.robot, setup.map.resolution_m);
  const sim::WorldMesh mesh = test::pitRoom();
  MissionRun run(setup, mesh, *planner);
  Walk walk;
  walk.record = run.fly();
  walk.zones = run.mission().zones();
  return walk;
}

bool isOverPitOrBlock(const Eigen::Vector2d& p) {
  constexpr double kSlack = 0.5;  // a zone may reach a little beyond what it marks
  const bool pit = p.x() > 4.0 - kSlack && p.x() < 5.2 + kSlack && std::abs(p.y()) < 1.3 + kSlack;
  const bool block = p.x() > 9.0 - kSlack && p.x() < 9.8 + kSlack && std::abs(p.y()) < 1.4 + kSlack;
  return pit || block;
}

Eigen::Vector2d centreOf(const NoGoZone& zone) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : zone.polygon) sum += corner;
  return sum / static_cast<double>(zone.polygon.size());
}

TEST(WalkerMission, PassesAPitAndABlockAndComesHome) {
  const Walk walk = walkPitRoom(Ground::kVerified, kSeed);
  EXPECT_EQ(walk.record.falls, 0) << walk.record.outcome;
  EXPECT_TRUE(walk.record.returned_home) << walk.record.outcome;
  EXPECT_GT(walk.record.remaining_at_home_s, 0.0);
  EXPECT_GT(walk.record.explored_volume_m3, 380.0) << walk.record.outcome;  // of 420 m3 of air
  double farthest = 0.0;
  for (const TimelineRow& row : walk.record.timeline)
    farthest = std::max(farthest, row.pose.position.x());
  EXPECT_GT(farthest, 10.0);  // beyond the pit and the block
  for (const NoGoZone& zone : walk.zones)
    EXPECT_TRUE(isOverPitOrBlock(centreOf(zone)))
        << zone.name << " at " << centreOf(zone).transpose();
}

TEST(WalkerMission, StaysOnItsFeetWhenPlansAndScansAreLateOrLost) {
  Delays delays;
  delays.plan_s = 1.0;
  delays.scan_s = 0.3;
  delays.scan_loss = 0.4;
  const Walk walk = walkPitRoom(Ground::kVerified, 2, delays);
  EXPECT_EQ(walk.record.falls, 0) << walk.record.outcome;
  EXPECT_TRUE(walk.record.returned_home) << walk.record.outcome;
  EXPECT_GT(walk.record.explored_volume_m3, 300.0) << walk.record.outcome;
}

/// Where it walks is chance, so that not every walk leads over the pit.
TEST(WalkerMission, FallsWhereTheGroundIsTakenOnTrust) {
  int falls = 0;
  for (std::uint64_t seed = kSeed; seed < kSeed + 4; ++seed) {
    const Walk walk = walkPitRoom(Ground::kTakenOnTrust, seed);
    EXPECT_EQ(walk.record.returned_home, walk.record.falls == 0) << walk.record.outcome;
    falls += walk.record.falls;
  }
  EXPECT_GT(falls, 0);
}

}  // namespace
}  // namespace spelunk::evaluation
