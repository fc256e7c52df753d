#include "spelunk/evaluation/tour_survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "spelunk/common/contract.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"

namespace spelunk::evaluation {
namespace {

RobotModel smallFlyer() {
  RobotModel robot;
  robot.box_m = {0.6, 0.6, 0.4};
  SensorModel sensor;
  sensor.columns = 360;
  sensor.fov_vertical_deg = 90.0;
  robot.sensor_models = {sensor};
  return robot;
}

const Pose kStart{{1.5, 0.0, 1.5}, 0.0};

TourSurvey surveyOfCorridor(const RobotModel& robot) {
  const sim::WorldMesh mesh = test::corridorWithPillar(24.0F, 4.0F);
  return surveyForTour(mesh, sim::MeshScene(mesh), kStart, robot);
}

double volumeOf(const std::vector<std::uint8_t>& seen, const TourSurvey& survey) {
  double volume = 0.0;
  for (std::size_t i = 0; i < survey.volumes_m3.size(); ++i)
    if ((seen[i >> 3] >> (i & 7) & 1) != 0) volume += survey.volumes_m3[i];
  return volume;
}

TEST(TargetVoxels, HoldTheWholeReachableVolume) {
  const sim::WorldMesh mesh = test::corridorWithPillar(24.0F, 4.0F);
  const ReachableSpace space = reachableSpace(mesh, kStart.position);
  const TargetVoxels targets(space, 0.8);
  const auto& volumes = targets.volumes_m3();
  EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0),
              reachableVolume(mesh, kStart.position).total_m3, 1e-6);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    EXPECT_EQ(targets.find(targets.centres()[i]), i);
    EXPECT_LE(volumes[i], 0.8 * 0.8 * 0.8 + 1e-9);
  }
  EXPECT_FALSE(targets.find({12.0, 30.0, 1.0}));
  EXPECT_FALSE(targets.find({12.0, 2.9, 1.0}));
}

TEST(TourSurvey, LeadsEverywhereWithoutTouching) {
  const sim::WorldMesh mesh = test::corridorWithPillar(24.0F, 4.0F);
  const sim::MeshScene scene(mesh);
  const RobotModel robot = smallFlyer();
  const TourSurvey survey = surveyForTour(mesh, scene, kStart, robot);
  ASSERT_GT(survey.outlooks.size(), 5U);
  EXPECT_EQ(survey.outlooks.front(), kStart.position);
  std::vector<std::uint32_t> group(survey.outlooks.size());
  std::iota(group.begin(), group.end(), 0U);
  for (const TourSurvey::Way& way : survey.ways) {
    EXPECT_EQ(way.points.front(), survey.outlooks[way.from]);
    EXPECT_EQ(way.points.back(), survey.outlooks[way.to]);
    EXPECT_GE(way.length_m + 1e-9, (survey.outlooks[way.to] - survey.outlooks[way.from]).norm());
    for (const Eigen::Vector3d& point : way.points)
      EXPECT_GT(scene.boxDistance(point, robot.box_m, 0.2), 0.05);
    const std::uint32_t old = group[way.to];
    std::replace(group.begin(), group.end(), old, group[way.from]);
  }
  EXPECT_EQ(std::count(group.begin(), group.end(), group.front()),
            static_cast<std::ptrdiff_t>(group.size()));
}

TEST(TourSurvey, OutlooksSeeNearlyEverythingTogetherAndNoneEverything) {
  const TourSurvey survey = surveyOfCorridor(smallFlyer());
  const double all = std::accumulate(survey.volumes_m3.begin(), survey.volumes_m3.end(), 0.0);
  std::vector<std::uint8_t> together(survey.seen.front().size(), 0);
  ASSERT_EQ(survey.seen.size(), survey.outlooks.size());
  for (const auto& seen : survey.seen) {
    EXPECT_LT(volumeOf(seen, survey), 0.8 * all);
    for (std::size_t i = 0; i < seen.size(); ++i)
      together[i] = static_cast<std::uint8_t>(together[i] | seen[i]);
  }
  EXPECT_GT(volumeOf(together, survey), 0.85 * all);
}

TEST(TourSurvey, StaysOnItsSideOfAGapTooNarrowForTheRobot) {
  RobotModel wide = smallFlyer();
  wide.box_m = {2.0, 2.0, 0.4};  // beside the pillar there are 1.75 m
  const TourSurvey survey = surveyOfCorridor(wide);
  for (const Eigen::Vector3d& outlook : survey.outlooks) EXPECT_LT(outlook.x(), 12.0);
}

TEST(TourSurvey, ATinyRobotDoesNotLeapThroughAThinWall) {
  sim::WorldMesh mesh;
  mesh.name = "walled";
  test::addBox(mesh, {0.0F, -0.5F, 0.0F}, {3.0F, 0.5F, 1.0F});
  test::addBox(mesh, {1.55F, -0.5F, 0.0F}, {1.551F, 0.5F, 1.0F});
  RobotModel tiny = smallFlyer();
  tiny.box_m = {0.05, 0.05, 0.05};
  const TourSurvey survey = surveyForTour(mesh, sim::MeshScene(mesh), {{0.5, 0.0, 0.5}, 0.0}, tiny);
  for (const Eigen::Vector3d& outlook : survey.outlooks) EXPECT_LT(outlook.x(), 1.55);
}

TEST(TourSurvey, IsWrittenAndAFullOrMissingFolderNamed) {
  const TourSurvey survey = surveyOfCorridor(smallFlyer());
  const test::TemporaryFolder folder;
  writeSurvey(survey, folder.at(""));
  std::ifstream rows(folder.at("survey_seen.bin"), std::ios::binary | std::ios::ate);
  EXPECT_EQ(static_cast<std::size_t>(rows.tellg()),
            survey.outlooks.size() * ((survey.volumes_m3.size() + 7) / 8));
  EXPECT_THROW(writeSurvey(survey, folder.at("none")), OutsideError);
}

TEST(TourSurvey, ARobotThatLooksOneWayTurnsAbout) {
  RobotModel around = smallFlyer();
  const TourSurvey all = surveyOfCorridor(around);
  RobotModel one_way = smallFlyer();
  SensorModel& camera = one_way.sensor_models.front();
  camera.fov_horizontal_deg = 90.0;
  camera.mount_roll_deg = 180.0;  // seen upside down, a symmetric field is the same
  const TourSurvey turned = surveyOfCorridor(one_way);
  ASSERT_EQ(all.outlooks.size(), turned.outlooks.size());
  for (std::size_t i = 0; i < all.seen.size(); ++i)
    EXPECT_NEAR(volumeOf(turned.seen[i], turned), volumeOf(all.seen[i], all),
                0.03 * volumeOf(all.seen[i], all));
}

}  // namespace
}  // namespace spelunk::evaluation
