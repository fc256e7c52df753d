#include "spelunk/sim/battery.h"

#include <gtest/gtest.h>

namespace spelunk::sim {
namespace {

TEST(Battery, FullOneLastsTheRobotsEndurance) {
  RobotModel robot;
  robot.endurance_s = 600.0;
  const Battery battery(flightPower({}), 0.0, robot);
  EXPECT_NEAR(battery.state().remaining_s, 600.0, 1e-9);
  EXPECT_EQ(battery.state().fraction, 1.0);
}

TEST(Battery, CruisingLastsTheRobotsEndurance) {
  RobotModel robot;
  robot.endurance_s = 600.0;
  Battery battery(flightPower({}), 0.0, robot);
  for (int k = 0; k < 5990; ++k) battery.draw(0.1, robot.speed_max_mps);
  EXPECT_FALSE(battery.isEmpty());
  EXPECT_NEAR(battery.state().remaining_s, 1.0, 1e-6);
  for (int k = 0; k < 11; ++k) battery.draw(0.1, robot.speed_max_mps);
  EXPECT_TRUE(battery.isEmpty());
  EXPECT_EQ(battery.state().energy_wh, 0.0);
  EXPECT_EQ(battery.state().remaining_s, 0.0);
}

TEST(Battery, MotionCostsTheSquareOfSpeed) {
  Battery battery(flightPower({}), 100.0, RobotModel{});
  EXPECT_NEAR(battery.state().energy_wh, 100.0, 1e-9);
  battery.draw(36.0, 2.0);
  EXPECT_NEAR(battery.state().power_w, 350.0 + 12.0 * 4.0, 1e-9);
  EXPECT_NEAR(battery.state().energy_wh, 100.0 - 3.98, 1e-9);
}

TEST(Battery, WalkingLastsTheRobotsEndurance) {
  RobotModel robot;
  robot.endurance_s = 3600.0;
  robot.speed_max_mps = 0.5;
  const WalkerParams params;
  Battery battery(walkingPower(params), 0.0, robot);
  for (int k = 0; k < 35990; ++k) battery.draw(0.1, 0.5);
  EXPECT_NEAR(battery.state().remaining_s, 1.0, 1e-4);
  EXPECT_NEAR(battery.state().power_w,
              params.standing_power_w + 0.5 * params.walking_power_w_per_mps, 1e-9);
}

TEST(Battery, FastFlightShortensWhatRemains) {
  Battery slow(flightPower({}), 0.0, RobotModel{});
  Battery fast(flightPower({}), 0.0, RobotModel{});
  for (int k = 0; k < 600; ++k) {
    slow.draw(0.1, 0.0);
    fast.draw(0.1, 4.0);
  }
  EXPECT_GT(slow.state().remaining_s, 840.0);
  EXPECT_LT(fast.state().remaining_s, 700.0);
}

}  // namespace
}  // namespace spelunk::sim
