#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "spelunk/common/log.h"
#include "spelunk/evaluation/mission_run.h"
#include "spelunk/mission/run_config.h"
#include "spelunk/planners/factory.h"
#include "support/meshes.h"

namespace spelunk::evaluation {
namespace {

struct Flight {
  RunRecord record;
  double endurance_s = 0.0;
};

/// The shipped robot with fewer rays a row.
Flight fly(const sim::WorldMesh& mesh, const std::string& robot, const std::string& planner_name,
           const Pose& start, double endurance_s,
           const std::vector<std::string>& assignments = {"sensor.lidar_16.columns=600"}) {
  setLogSink([](LogLevel, const std::string&) {});
  mission::RunChoice choice;
  choice.share_dir = SPELUNK_SOURCE_DIR;
  choice.robot = robot;
  choice.assignments = assignments;
  mission::RunConfig config = mission::loadRunConfig(choice);
  RunSetup setup;
  setup.robot = config.robot;
  setup.sim = sim::readSimParams(config.tree);
  setup.map = config.map;
  setup.mission = config.mission;
  setup.terrain = config.terrain;
  setup.start = start;
  setup.time_limit_s = endurance_s;
  const auto planner =
      planners::makePlanner(planner_name, config.tree, setup.robot, setup.map.resolution_m);
  return {MissionRun(setup, mesh, *planner).fly(), endurance_s};
}

/// The openings a mission names, by place.
std::vector<Eigen::Vector3d> openingsOf(const RunRecord& record) {
  std::vector<Eigen::Vector3d> places;
  for (const planners::RemainingTarget& target : record.remaining_targets)
    if (target.why.find("open to the outside at (") == 0) places.push_back(target.position);
  return places;
}

constexpr double kEndurance_s = 300.0;
const Pose kStart{{3.0, 2.5, 1.5}, 0.0};

/// A way from the start to the portal and back, metres.
double thereAndBack(const Pose& start) { return 2.0 * (40.0 - start.position.x()); }

void expectLookedAtAndLeft(const RunRecord& record, const Pose& start, double endurance_s) {
  EXPECT_TRUE(record.returned_home) << record.outcome;
  EXPECT_EQ(record.outcome.find("explored: "), 0U) << record.outcome;
  EXPECT_NE(record.outcome.find("; 1 opening to the outside"), std::string::npos) << record.outcome;
  const std::vector<Eigen::Vector3d> openings = openingsOf(record);
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].x(), 40.0, 1.0);
  EXPECT_NEAR(openings[0].y(), 2.5, 2.5);  // within the portal
  EXPECT_NEAR(openings[0].z(), 1.75, 1.75);
  // Once to see the gallery, once to look at the portal, once for corners that were passed by; and
  // once more, for nbvp draws its ways at random.
  EXPECT_LT(record.path_length_m, 4.0 * thereAndBack(start));
  EXPECT_LT(record.mission_time_s, 0.5 * endurance_s);
  EXPECT_GT(record.min_clearance_m, 0.0);
  EXPECT_GT(record.explored_volume_m3, 0.9 * 40.0 * 5.0 * 3.5);
}

class PlannerAtAPortal : public ::testing::TestWithParam<std::string> {};

TEST_P(PlannerAtAPortal, LooksAtItAndLeavesIt) {
  const Flight flight = fly(test::galleryWithPortal(), "aerial", GetParam(), kStart, kEndurance_s);
  expectLookedAtAndLeft(flight.record, kStart, flight.endurance_s);
}

INSTANTIATE_TEST_SUITE_P(Aerial, PlannerAtAPortal, ::testing::ValuesIn(planners::plannerNames()));

class WalkerAtAPortal : public ::testing::TestWithParam<std::string> {};

TEST_P(WalkerAtAPortal, LooksAtItAndLeavesIt) {
  const Pose start{{3.0, 2.5, 0.6}, 0.0};
  const double endurance_s = 4.0 * kEndurance_s;  // a quarter of the speed
  const Flight flight = fly(test::galleryWithPortal(), "walker", GetParam(), start, endurance_s);
  expectLookedAtAndLeft(flight.record, start, flight.endurance_s);
  EXPECT_EQ(flight.record.falls, 0);
}

INSTANTIATE_TEST_SUITE_P(OnFoot, WalkerAtAPortal, ::testing::Values("gbplanner", "nbvp"));

TEST(PortalMission, ABranchIsExploredThoughThePortalLiesOnTheWay) {
  const Pose start{{3.0, 2.0, 1.5}, 0.0};
  const Flight flight =
      fly(test::galleryWithPortalAndBranch(), "aerial", "gbplanner", start, kEndurance_s);
  const RunRecord& record = flight.record;
  EXPECT_TRUE(record.returned_home);
  EXPECT_EQ(record.outcome.find("explored: "), 0U) << record.outcome;
  EXPECT_EQ(openingsOf(record).size(), 1U);
  const double layer_m2 = 2.0 * (4.0 + 3.5) * 0.2;  // hit voxels count as well
  EXPECT_GT(record.explored_volume_m3, 0.9 * (40.0 + 30.0) * (4.0 * 3.5 + layer_m2));
}

TEST(PortalMission, ARobotThatSeesTheOpenStaysWithinTheMesh) {
  const Flight flight = fly(test::galleryWithPortal(), "inspector", "informed",
                            {{36.0, 2.5, 1.5}, 0.0}, 400.0, {"map.range_max_m=4"});
  EXPECT_TRUE(flight.record.returned_home) << flight.record.outcome;
  double farthest_x = 0.0;
  for (const TimelineRow& row : flight.record.timeline)
    farthest_x = std::max(farthest_x, row.pose.position.x());
  EXPECT_GT(farthest_x, 36.5);
  EXPECT_LT(farthest_x, 40.0);
  EXPECT_TRUE(openingsOf(flight.record).empty());
}

TEST(PortalMission, AClosedGalleryHasNoOpening) {
  sim::WorldMesh mesh;
  test::addBox(mesh, Eigen::Vector3f::Zero(), {40.0F, 5.0F, 3.5F});
  const Flight flight = fly(mesh, "aerial", "gbplanner", kStart, kEndurance_s);
  EXPECT_EQ(flight.record.outcome.find("explored: "), 0U) << flight.record.outcome;
  EXPECT_TRUE(openingsOf(flight.record).empty());
}

TEST(PortalMission, ADriftLongerThanTheSensorsReachIsSeenToItsEnd) {
  sim::WorldMesh mesh;
  constexpr float kLength_m = 150.0F;
  test::addBox(mesh, Eigen::Vector3f::Zero(), {kLength_m, 4.0F, 3.5F});
  const Pose start{{3.0, 2.0, 1.5}, 0.0};
  const Flight flight = fly(mesh, "aerial", "gbplanner", start, kEndurance_s);
  const double layer_m2 = 2.0 * (4.0 + 3.5) * 0.2;  // hit voxels count as well
  EXPECT_GT(flight.record.explored_volume_m3, 0.95 * kLength_m * (4.0 * 3.5 + layer_m2));
  EXPECT_EQ(flight.record.outcome.find("explored: "), 0U) << flight.record.outcome;
  EXPECT_TRUE(openingsOf(flight.record).empty());
}

/// The share of all it explored that a mission saw in the last third of its endurance; none if it
/// had turned home before.
std::optional<double> lastThird(const Flight& flight) {
  const double begin_s = flight.endurance_s * 2.0 / 3.0;
  double before = 0.0;
  bool explores = false;
  for (const TimelineRow& row : flight.record.timeline) {
    if (row.t_s <= begin_s) before = row.explored_m3;
    const bool is_on_its_way = row.state == mission::MissionState::kExplore ||
                               row.state == mission::MissionState::kReposition;
    explores |= row.t_s > begin_s && is_on_its_way;
  }
  if (!explores) return std::nullopt;
  return (flight.record.explored_volume_m3 - before) / flight.record.explored_volume_m3;
}

TEST(PortalMission, TheLastThirdOfTheEnduranceBringsSomethingOrIsNotFlown) {
  sim::WorldMesh tunnel;  // both ends are open
  for (const float y : {0.0F, 4.0F}) test::addRectangle(tunnel, 1, y, {0.0F, 0.0F}, {60.0F, 3.0F});
  for (const float z : {0.0F, 3.0F}) test::addRectangle(tunnel, 2, z, {0.0F, 0.0F}, {60.0F, 4.0F});
  sim::WorldMesh hall;  // without a roof
  test::addRectangle(hall, 2, 0.0F, {0.0F, 0.0F}, {25.0F, 20.0F});
  for (const float x : {0.0F, 25.0F}) test::addRectangle(hall, 0, x, {0.0F, 0.0F}, {20.0F, 6.0F});
  for (const float y : {0.0F, 20.0F}) test::addRectangle(hall, 1, y, {0.0F, 0.0F}, {25.0F, 6.0F});
  const std::map<std::string, std::pair<sim::WorldMesh, Pose>> worlds{
      {"tunnel", {tunnel, {{30.0, 2.0, 1.5}, 0.0}}},
      {"hall", {hall, {{5.0, 10.0, 1.5}, 0.0}}},
      {"branch", {test::galleryWithPortalAndBranch(), {{3.0, 2.0, 1.5}, 0.0}}}};
  for (const auto& [name, world] : worlds)
    for (const char* planner : {"gbplanner", "frontier_nearest"}) {
      const Flight flight = fly(world.first, "aerial", planner, world.second, kEndurance_s);
      EXPECT_TRUE(flight.record.returned_home) << name << ": " << flight.record.outcome;
      EXPECT_GE(lastThird(flight).value_or(1.0), 0.01) << name << ", " << planner;
    }
}

}  // namespace
}  // namespace spelunk::evaluation
