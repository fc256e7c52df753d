#include "spelunk/planners/shared/robot_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/planners/baselines/nbvp_params.h"
#include "spelunk/planners/gbplanner/gb_planner_params.h"

namespace spelunk::planners {
namespace {

RobotModel robotThatSees(double range_m, double horizontal_deg, double vertical_deg) {
  SensorModel sensor;
  sensor.range_max_m = sensor.gain_range_m = range_m;
  sensor.fov_horizontal_deg = horizontal_deg;
  sensor.fov_vertical_deg = vertical_deg;
  RobotModel robot;
  robot.sensor_models = {sensor};
  return robot;
}

TEST(LookVolume, IsThatOfTheFieldOfViewUpToTheRangeOfGains) {
  const double ball_m3 = 4.0 / 3.0 * M_PI * 27.0;
  EXPECT_NEAR(lookVolume(robotThatSees(3.0, 360.0, 180.0)), ball_m3, 1e-6 * ball_m3);
  EXPECT_NEAR(lookVolume(robotThatSees(3.0, 90.0, 180.0)), ball_m3 / 4.0, 1e-6 * ball_m3);
  EXPECT_EQ(lookVolume(RobotModel{}), 0.0);
}

TEST(PassableThreshold, IsLoweredToAShareOfALookAndNeverRaised) {
  const RobotModel robot = robotThatSees(3.0, 90.0, 60.0);
  const double look_m3 = lookVolume(robot);
  EXPECT_DOUBLE_EQ(passableThreshold(800.0, 0.5, robot), 0.5 * look_m3);
  EXPECT_EQ(passableThreshold(0.1 * look_m3, 0.5, robot), 0.1 * look_m3);
  EXPECT_EQ(passableThreshold(800.0, 0.5, RobotModel{}), 800.0);
}

TEST(PassableThreshold, OfThePlannersFollowsFromTheRobot) {
  const RobotModel weak = robotThatSees(3.0, 90.0, 60.0);
  const auto gbplanner = gbplanner::GbPlannerParams{}.resolvedFor(weak);
  EXPECT_LT(gbplanner.gain_threshold_m3, lookVolume(weak));
  EXPECT_LT(gbplanner.frontier_gain_m3, gbplanner.gain_threshold_m3);
  EXPECT_LT(baselines::NbvpParams{}.resolvedFor(weak).gain_min_m3, lookVolume(weak));
  const RobotModel strong = robotThatSees(50.0, 360.0, 30.0);
  EXPECT_EQ(gbplanner::GbPlannerParams{}.resolvedFor(strong).gain_threshold_m3,
            gbplanner::GbPlannerParams{}.gain_threshold_m3);
}

}  // namespace
}  // namespace spelunk::planners
