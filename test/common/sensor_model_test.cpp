#include "spelunk/common/sensor_model.h"

#include <gtest/gtest.h>

namespace spelunk {
namespace {

TEST(SensorModel, LidarRaysCoverTheFieldOfViewOnce) {
  SensorModel lidar;
  const auto rays = rayDirections(lidar);
  ASSERT_EQ(rays.size(), 16u * 1800u);
  EXPECT_NEAR(rays.front().z(), std::sin(-15.0 * M_PI / 180.0), 1e-6);
  EXPECT_NEAR(rays.back().z(), std::sin(15.0 * M_PI / 180.0), 1e-6);
  for (const auto& ray : rays) ASSERT_NEAR(ray.norm(), 1.0F, 1e-6F);
  EXPECT_GT((rays[0] - rays[1799]).norm(), 1e-3) << "first column repeated";
}

TEST(SensorModel, CameraRaysStayInsideTheFieldOfViewAndStartAtTheLowestRow) {
  SensorModel camera;
  camera.kind = "depth_camera";
  camera.fov_horizontal_deg = 90.0;
  camera.fov_vertical_deg = 60.0;
  camera.rows = 60;
  camera.columns = 80;
  const auto rays = rayDirections(camera);
  EXPECT_LT(rays.front().z(), 0.0F);
  for (const auto& ray : rays) {
    ASSERT_GT(ray.x(), 0.0F);
    ASSERT_LT(std::abs(ray.y() / ray.x()), 1.0F);
    ASSERT_LT(std::abs(ray.z() / ray.x()), std::tan(M_PI / 6.0) + 1e-5);
  }
}

TEST(SensorModel, PositivePitchLooksDown) {
  SensorModel camera;
  camera.mount_pitch_deg = 30.0;
  EXPECT_LT((T_base_sensor(camera).linear() * Eigen::Vector3d::UnitX()).z(), -0.4);
}

double elevation(const Eigen::Vector3f& ray) {
  return std::asin(static_cast<double>(ray.z())) * 180.0 / M_PI;
}

TEST(SensorModel, FieldNeedNotBeSymmetric) {
  SensorModel lidar;
  lidar.fov_lower_deg = -7.0;
  lidar.fov_upper_deg = 52.0;
  const auto rays = rayDirections(lidar);
  EXPECT_NEAR(elevation(rays.front()), -7.0, 1e-3);
  EXPECT_NEAR(elevation(rays.back()), 52.0, 1e-3);
  lidar.kind = "depth_camera";
  lidar.fov_horizontal_deg = 60.0;
  for (const auto& pixel : rayDirections(lidar)) {
    ASSERT_GT(pixel.z() / pixel.x(), std::tan(-7.0 * M_PI / 180.0));
    ASSERT_LT(pixel.z() / pixel.x(), std::tan(52.0 * M_PI / 180.0));
  }
  EXPECT_TRUE(lidar.problems().empty());
}

TEST(SensorModel, ShortFormAndLimitsGiveTheSameRays) {
  SensorModel shortly;
  shortly.fov_vertical_deg = 57.0;
  SensorModel by_limits;
  by_limits.fov_lower_deg = -28.5;
  by_limits.fov_upper_deg = 28.5;
  for (const char* kind : {"lidar", "depth_camera"}) {
    for (SensorModel* sensor : {&shortly, &by_limits}) {
      sensor->kind = kind;
      sensor->fov_horizontal_deg = 90.0;
    }
    EXPECT_EQ(rayDirections(shortly), rayDirections(by_limits)) << kind;
  }
}

TEST(SensorModel, ContradictingFieldsAreRefused) {
  SensorModel sensor;
  sensor.fov_vertical_deg = 30.0;
  sensor.fov_lower_deg = -7.0;
  sensor.fov_upper_deg = 52.0;
  ASSERT_EQ(sensor.problems().size(), 1u);
  EXPECT_NE(sensor.problems().front().find("59"), std::string::npos) << sensor.problems().front();
  sensor.fov_vertical_deg = 59.0;
  EXPECT_TRUE(sensor.problems().empty());
  sensor.fov_lower_deg = 60.0;
  EXPECT_EQ(sensor.problems().size(), 1u);
}

TEST(SensorModel, UpsideDownLooksAheadAndSwapsUpAndDown) {
  SensorModel sensor;
  sensor.mount_roll_deg = 180.0;
  const Eigen::Matrix3d R_base_sensor = T_base_sensor(sensor).linear();
  EXPECT_TRUE((R_base_sensor * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
  EXPECT_TRUE((R_base_sensor * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitZ(), 1e-9));
}

TEST(SensorModel, RollComesAfterYawAndPitch) {
  SensorModel sensor;
  sensor.mount_yaw_deg = 90.0;
  sensor.mount_roll_deg = 90.0;
  // Turned to the left, then rolled about the axis that now points left: its top points ahead.
  const Eigen::Vector3d top = T_base_sensor(sensor).linear() * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(top.isApprox(Eigen::Vector3d::UnitX(), 1e-9)) << top.transpose();
}

TEST(SensorModel, SeesAllAroundOnlyIfTheHorizonStaysInItsField) {
  SensorModel sensor;
  EXPECT_TRUE(seesAllAround(sensor));
  sensor.mount_roll_deg = 180.0;
  EXPECT_TRUE(seesAllAround(sensor)) << "upside down";
  sensor.mount_roll_deg = 90.0;
  EXPECT_FALSE(seesAllAround(sensor)) << "a vertical ring";
  sensor.mount_roll_deg = 0.0;
  sensor.mount_pitch_deg = 10.0;
  EXPECT_TRUE(seesAllAround(sensor)) << "15 degrees of field to each side";
  sensor.fov_lower_deg = -7.0;
  sensor.fov_upper_deg = 52.0;
  EXPECT_FALSE(seesAllAround(sensor)) << "the horizon behind lies below its field";
  sensor.mount_pitch_deg = 0.0;
  EXPECT_TRUE(seesAllAround(sensor));
  sensor.fov_horizontal_deg = 180.0;
  EXPECT_FALSE(seesAllAround(sensor));
}

TEST(SensorModel, GainsFollowFromWhatSensorAndMapSee) {
  SensorModel sensor;
  EXPECT_EQ(resolved(sensor, 100.0).gain_range_m, sensor.range_max_m);
  EXPECT_EQ(resolved(sensor, 12.0).gain_range_m, 12.0);
  sensor.gain_range_m = 7.0;
  EXPECT_EQ(resolved(sensor, 12.0).gain_range_m, 7.0);
  EXPECT_EQ(resolved(sensor, 12.0).fov_upper_deg, 15.0);
}

TEST(SensorModel, RaysOfGainsLieCloserThanTheField) {
  SensorModel narrow;
  narrow.fov_horizontal_deg = 10.0;
  narrow.gain_resolution_deg = 15.0;
  EXPECT_EQ(narrow.problems().size(), 1u);
}

TEST(SensorModel, ImpossibleDescriptionsAreNamed) {
  SensorModel sensor;
  sensor.kind = "sonar";
  sensor.range_min_m = 60.0;
  EXPECT_EQ(sensor.problems().size(), 2u);
}

TEST(ScanThinning, TakesAllScansWithoutAPeriod) {
  ScanThinning thinning(0.0);
  for (const double stamp_s : {1.0, 1.1, 1.2}) EXPECT_TRUE(thinning.takes(stamp_s));
}

TEST(ScanThinning, CountsFromTheLastScanItTook) {
  ScanThinning thinning(0.2);
  std::vector<double> taken;
  for (const double stamp_s : {0.0, 0.1, 0.2, 0.35, 0.45, 0.55, 1.0})
    if (thinning.takes(stamp_s)) taken.push_back(stamp_s);
  EXPECT_EQ(taken, (std::vector<double>{0.0, 0.2, 0.45, 1.0}));
}

TEST(ScanThinning, TakesAScanOfAClockThatJumpedBack) {
  ScanThinning thinning(0.2);
  EXPECT_TRUE(thinning.takes(100.0));
  EXPECT_TRUE(thinning.takes(3.0));
  EXPECT_FALSE(thinning.takes(3.1));
  EXPECT_TRUE(thinning.takes(3.2));
}

}  // namespace
}  // namespace spelunk
