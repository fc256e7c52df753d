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
