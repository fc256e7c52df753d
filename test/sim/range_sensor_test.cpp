#include "spelunk/sim/range_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spelunk/common/params.h"
#include "spelunk/common/robot_model.h"
#include "support/meshes.h"

namespace spelunk::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

Isometry3d at(const Vector3d& position) {
  Isometry3d transform = Isometry3d::Identity();
  transform.translate(position);
  return transform;
}

SimulatedScan scanFrom(const SensorModel& model, double dust, const Isometry3d& T_world_base,
                       const MeshScene& scene, std::uint64_t seed = 1) {
  RangeSensor sensor(model, dust, Rng(seed));
  return sensor.scan(scene, T_world_base, T_world_base, 0.0).value();
}

SensorModel exactLidar() {
  SensorModel model;
  model.range_noise_stddev_m = 0.0;
  return model;
}

TEST(RangeSensor, PointsLieOnTheWallsWhateverTheAttitude) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  Isometry3d T_world_base = at({1, -1, 1.5});
  T_world_base.rotate(Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()));
  const SimulatedScan scan = scanFrom(exactLidar(), 0.0, T_world_base, scene);
  ASSERT_EQ(scan.scan.points.size(), 28800U);
  for (const Vector3f& point : scan.scan.points) {
    const Vector3d world = scan.T_world_sensor_true * point.cast<double>();
    const double off =
        std::min({std::abs(5.0 - std::abs(world.x())), std::abs(4.0 - std::abs(world.y())),
                  std::abs(world.z()), std::abs(4.0 - world.z())});
    EXPECT_LT(off, 1e-4);
  }
}

TEST(RangeSensor, ReportsThePoseTheOdometryBelieves) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  SensorModel model = exactLidar();
  model.mount_m = {0.1, 0.0, 0.2};
  RangeSensor sensor(model, 0.0, Rng(1));
  const SimulatedScan scan = sensor.scan(scene, at({1, 0, 1}), at({1.5, 0, 1}), 2.5).value();
  EXPECT_EQ(scan.scan.stamp_s, 2.5);
  EXPECT_EQ(scan.scan.sensor, "lidar_16");
  EXPECT_TRUE(scan.T_world_sensor_true.translation().isApprox(Vector3d(1.1, 0, 1.2), 1e-12));
  EXPECT_TRUE(scan.scan.T_world_sensor.translation().isApprox(Vector3d(1.6, 0, 1.2), 1e-12));
}

TEST(RangeSensor, NoiseHasTheGivenSpread) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  SensorModel model;
  model.range_noise_stddev_m = 0.03;
  const SimulatedScan scan = scanFrom(model, 0.0, at({0, 0, 2}), scene);
  ASSERT_EQ(scan.scan.points.size(), scan.true_ranges.size());
  double sum = 0.0;
  double squares = 0.0;
  double worst = 0.0;
  for (std::size_t k = 0; k < scan.true_ranges.size(); ++k) {
    const double error = scan.scan.points[k].norm() - scan.true_ranges[k];
    sum += error;
    squares += error * error;
    worst = std::max(worst, std::abs(error));
  }
  const auto count = static_cast<double>(scan.true_ranges.size());
  EXPECT_NEAR(sum / count, 0.0, 0.0008);
  EXPECT_NEAR(std::sqrt(squares / count), 0.03, 0.0006);
  EXPECT_LT(worst, 3.5 * 0.03);
  EXPECT_GT(worst, 2.8 * 0.03);
}

TEST(RangeSensor, NoiseDiffersFromScanToScan) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  RangeSensor sensor(SensorModel{}, 0.0, Rng(1));
  const SimulatedScan first = sensor.scan(scene, at({0, 0, 2}), at({0, 0, 2}), 0.0).value();
  const SimulatedScan second = sensor.scan(scene, at({0, 0, 2}), at({0, 0, 2}), 0.1).value();
  EXPECT_EQ(first.true_ranges, second.true_ranges);
  EXPECT_NE(first.scan.points[0], second.scan.points[0]);
  EXPECT_NEAR(sensor.nextScanTime(), 0.2, 1e-12);
}

TEST(RangeSensor, SeedDecidesTheNoise) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  const auto points = [&](std::uint64_t seed) {
    return scanFrom(SensorModel{}, 0.1, at({0, 0, 2}), scene, seed).scan.points;
  };
  EXPECT_EQ(points(3), points(3));
  EXPECT_NE(points(3), points(4));
}

TEST(RangeSensor, LosesTheGivenShareOfReturns) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  SensorModel model = exactLidar();
  model.dropout_probability = 0.25;
  const SimulatedScan scan = scanFrom(model, 0.0, at({0, 0, 2}), scene);
  EXPECT_NEAR(static_cast<double>(scan.scan.points.size()), 0.75 * 28800.0, 400.0);
  EXPECT_EQ(scan.true_ranges.size(), 28800U);
}

TEST(RangeSensor, ReportsMissesAtItsFullRangeIfItDoesSo) {
  const MeshScene scene(test::boxRoom({60, 2, 4}));
  SensorModel model = exactLidar();
  model.range_max_m = 10.0;
  model.dropout_probability = 0.25;
  const std::size_t returns = scanFrom(model, 0.0, at({0, 0, 2}), scene).scan.points.size();
  model.reports_misses = true;
  const SimulatedScan scan = scanFrom(model, 0.0, at({0, 0, 2}), scene);
  const auto misses = std::count_if(scan.scan.points.begin(), scan.scan.points.end(),
                                    [](const Vector3f& p) { return p.norm() > 9.9999F; });
  EXPECT_GT(misses, 1000);
  EXPECT_EQ(scan.scan.points.size(), returns + static_cast<std::size_t>(misses));
  EXPECT_LT(scan.scan.points.size(), 28800U) << "a lost return is no miss";
}

TEST(RangeSensor, DustReturnsEarly) {
  const MeshScene scene(test::boxRoom({10, 8, 4}));
  const SimulatedScan clear = scanFrom(exactLidar(), 0.0, at({0, 0, 2}), scene);
  const SimulatedScan dusty = scanFrom(exactLidar(), 0.1, at({0, 0, 2}), scene);
  EXPECT_EQ(clear.true_ranges, dusty.true_ranges);
  ASSERT_EQ(dusty.scan.points.size(), 28800U);
  int early = 0;
  for (std::size_t k = 0; k < dusty.scan.points.size(); ++k) {
    EXPECT_LE(dusty.scan.points[k].norm(), dusty.true_ranges[k] + 1e-4F);
    if (dusty.scan.points[k].norm() < dusty.true_ranges[k] - 1e-3F) ++early;
  }
  EXPECT_NEAR(early, 2880, 200);
}

TEST(RangeSensor, KeepsToItsRanges) {
  const MeshScene scene(test::boxRoom({60, 2, 4}));
  SensorModel model = exactLidar();
  model.range_min_m = 1.5;
  model.range_max_m = 12.0;
  const SimulatedScan scan = scanFrom(model, 0.0, at({0, 0, 2}), scene);
  EXPECT_LT(scan.scan.points.size(), 28800U);
  EXPECT_GT(scan.scan.points.size(), 100U);
  for (const Vector3f& point : scan.scan.points) {
    EXPECT_GE(point.norm(), 1.5F - 1e-5F);
    EXPECT_LT(point.norm(), 12.0F + 1e-5F);
  }
  EXPECT_EQ(*std::max_element(scan.true_ranges.begin(), scan.true_ranges.end()), 12.0F);
}

TEST(RangeSensor, ShippedDepthCameraSeesTheWallAhead) {
  ParamTree tree;
  tree.set("robot.sensors", "[depth_camera]", "test");
  const RobotModel robot = loadRobot(tree, "aerial", std::string(SPELUNK_SOURCE_DIR) + "/config");
  ASSERT_EQ(robot.sensor_models.size(), 1U);
  SensorModel camera = robot.sensor_models[0];
  camera.range_noise_stddev_m = 0.0;
  const MeshScene scene(test::boxRoom({10, 30, 20}));
  const SimulatedScan scan = scanFrom(camera, 0.0, at({0, 0, 10}), scene);
  ASSERT_EQ(scan.true_ranges.size(), static_cast<std::size_t>(camera.rows * camera.columns));
  ASSERT_EQ(scan.scan.points.size(), scan.true_ranges.size());
  for (const Vector3f& point : scan.scan.points) EXPECT_NEAR(point.x(), 4.85, 1e-4);
}

TEST(RangeSensor, DepthCameraSeesNothingBehindIt) {
  SensorModel camera;
  camera.kind = "depth_camera";
  camera.fov_horizontal_deg = 80.0;
  camera.fov_vertical_deg = 60.0;
  camera.rows = 30;
  camera.columns = 40;
  camera.range_max_m = 8.0;
  const MeshScene scene(test::boxRoom({40, 40, 30}));
  const SimulatedScan scan = scanFrom(camera, 0.0, at({-18, 0, 15}), scene);
  EXPECT_TRUE(scan.scan.points.empty());  // the near wall is behind
}

}  // namespace
}  // namespace spelunk::sim
