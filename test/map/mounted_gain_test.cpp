#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "map/template_rays.h"
#include "map_worlds.h"
#include "spelunk/common/pose.h"
#include "spelunk/map/volumetric_gain.h"

namespace spelunk::map {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kRange_m = 8.0;
const Eigen::Vector3d kPlace(0.1, 0.1, 1.1);

/// Rows and columns as far apart as the rays of a gain, so that both divide the field alike.
SensorModel lidarOf(double horizontal_deg, double lower_deg, double upper_deg) {
  constexpr double kAngle_deg = 3.0;
  SensorModel sensor;
  sensor.fov_horizontal_deg = horizontal_deg;
  sensor.fov_lower_deg = lower_deg;
  sensor.fov_upper_deg = upper_deg;
  sensor.gain_range_m = kRange_m;
  sensor.gain_resolution_deg = kAngle_deg;
  sensor.rows = static_cast<int>(std::lround((upper_deg - lower_deg) / kAngle_deg)) + 1;
  const int gaps = static_cast<int>(std::lround(horizontal_deg / kAngle_deg));
  sensor.columns = horizontal_deg >= 360.0 ? gaps : gaps + 1;
  return sensor;
}

SensorModel mounted(SensorModel sensor, double roll_deg, double pitch_deg, double yaw_deg) {
  sensor.mount_roll_deg = roll_deg;
  sensor.mount_pitch_deg = pitch_deg;
  sensor.mount_yaw_deg = yaw_deg;
  return sensor;
}

/// Unknown space below the floor, above 4 m, and to the left beyond 2 m; all else is free.
LocalWindow lopsidedWorld() {
  OccupancyMap map{MapParams{}};
  map.markFree({{-11.0, -11.0, 0.0}, {11.0, 2.0, 4.0}});
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(12.0);
  return LocalWindow(*map.freeze(), {-half, half});
}

/// What the sensor's own rays, turned by its mounting and the robot's yaw, pass of unknown space:
/// each stands for its share of the field, summed up in small steps.
double unknownOnItsRays(const SensorModel& sensor, const LocalWindow& window, double yaw) {
  constexpr double kStep_m = 0.05;
  const Eigen::Isometry3d T_world_sensor = T_world_base({kPlace, yaw}) * T_base_sensor(sensor);
  const double angle = sensor.gain_resolution_deg * kDegree;
  double volume_m3 = 0.0;
  for (const Eigen::Vector3f& ray : rayDirections(sensor)) {
    const Eigen::Vector3d direction = T_world_sensor.linear() * ray.cast<double>();
    const double share = angle * angle * std::hypot(ray.x(), ray.y());
    for (double along = 0.5 * kStep_m; along < kRange_m; along += kStep_m)
      if (window.at(window.indexOf(T_world_sensor.translation() + along * direction)) ==
          Occupancy::kUnknown)
        volume_m3 += share * along * along * kStep_m;
  }
  return volume_m3;
}

double gainOf(const SensorModel& sensor, const LocalWindow& window, double yaw) {
  return GainEvaluator({sensor}, window.resolution(), GainCounting::kCone)
      .evaluate(window, kPlace, yaw, AxisAlignedBox{})
      .unknown_m3;
}

struct Mounting {
  std::string name;
  SensorModel sensor;
};

class MountedGain : public testing::TestWithParam<Mounting> {};

TEST_P(MountedGain, EqualsTheSumOverTheSensorsOwnRays) {
  const LocalWindow window = lopsidedWorld();
  for (const double yaw : {0.0, 0.4, 1.6, -2.7}) {
    const double plain_m3 = unknownOnItsRays(GetParam().sensor, window, yaw);
    ASSERT_GT(plain_m3, 20.0);
    EXPECT_NEAR(gainOf(GetParam().sensor, window, yaw), plain_m3, 0.06 * plain_m3) << yaw;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mountings, MountedGain,
    testing::Values(Mounting{"lopsided", lidarOf(360, -7, 53)},
                    Mounting{"upside_down", mounted(lidarOf(360, -7, 53), 180, 0, 0)},
                    Mounting{"upside_down_by_pitch", mounted(lidarOf(120, -7, 53), 0, 180, 0)},
                    Mounting{"on_its_side", mounted(lidarOf(360, -7, 53), 90, 0, 0)},
                    Mounting{"rolled", mounted(lidarOf(360, -15, 15), -35, 0, 0)},
                    Mounting{"pitched", mounted(lidarOf(360, -7, 53), 0, 25, 0)},
                    Mounting{"turned_every_way", mounted(lidarOf(90, -10, 50), 30, -20, 140)},
                    Mounting{"upside_down_half", mounted(lidarOf(180, -30, 6), 180, 0, 75)},
                    Mounting{"level_half", mounted(lidarOf(180, -30, 6), 0, 0, -110)}),
    [](const auto& mounting) { return mounting.param.name; });

TEST(MountedGain, UpsideDownIsAnotherFieldThanUpright) {
  const LocalWindow window = lopsidedWorld();
  const SensorModel upright = lidarOf(360, -4, 53);
  const double above_m3 = gainOf(upright, window, 0.0);
  const double below_m3 = gainOf(mounted(upright, 180, 0, 0), window, 0.0);
  EXPECT_GT(below_m3, 1.2 * above_m3) << "the floor is nearer than the roof";
}

TEST(MountedGain, OfASensorOnItsSideTurnsWithTheRobot) {
  OccupancyMap map{MapParams{}};
  map.markFree({{-11.0, -2.0, -11.0}, {11.0, 2.0, 11.0}});  // a slot along x
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(12.0);
  const LocalWindow window(*map.freeze(), {-half, half});
  SensorModel ring = mounted(lidarOf(360, -6, 6), 90, 0, 0);
  for (const double angle_deg : {3.0, 0.5}) {  // as many lists as there is room for, and too many
    ring.gain_resolution_deg = angle_deg;
    // Its ring lies in the robot's x-z plane: along the slot, or across it.
    EXPECT_LT(3.0 * gainOf(ring, window, 0.0), gainOf(ring, window, 0.5 * M_PI)) << angle_deg;
  }
}

TEST(MountedGain, ListsOfTiltedSensorsStaySmall) {
  SensorModel tilted = mounted(lidarOf(360, -45, 45), 10, 0, 0);
  tilted.gain_range_m = 50.0;
  tilted.gain_resolution_deg = 1.0;
  const TemplateRays rays(tilted, 0.15);
  EXPECT_LT(rays.steps().size(), std::size_t{1} << 23);
  EXPECT_GE(rays.rays().size(), 24 * rays.headingAt(0.0).count);
}

TEST(MountedGain, ReachInHeightIsThatOfTheRays) {
  const GainEvaluator flat({lidarOf(360, -15, 15)}, 0.2);
  const GainEvaluator steep({lidarOf(360, -7, 53)}, 0.2);
  EXPECT_NEAR(flat.reachInHeight(), kRange_m * std::sin(15.0 * kDegree), 0.5);
  EXPECT_NEAR(steep.reachInHeight(), kRange_m * std::sin(53.0 * kDegree), 0.5);
  EXPECT_LE(steep.reachInHeight(), steep.reach());
}

}  // namespace
}  // namespace spelunk::map
