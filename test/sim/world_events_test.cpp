#include "spelunk/sim/world_events.h"

#include <gtest/gtest.h>

#include "spelunk/common/contract.h"
#include "spelunk/sim/simulator.h"
#include "support/meshes.h"

namespace spelunk::sim {
namespace {

/// Walks along x at 1 m/s.
void walk(WorldEvents& events, double from_s, double to_s) {
  for (double t = from_s; t <= to_s; t += 0.1) events.update(t, {t, 0.0, 1.0});
}

TEST(WorldEvents, RockFallsWhereTheRobotWasAndStays) {
  WorldEvents events({"fall 20 8"});
  walk(events, 0.0, 19.8);
  EXPECT_TRUE(events.boxes().empty());
  walk(events, 19.9, 20.5);
  ASSERT_EQ(events.boxes().size(), 1U);
  const AxisAlignedBox rock = events.boxes().front();
  EXPECT_NEAR(0.5 * (rock.min.x() + rock.max.x()), 12.0, 0.5);
  walk(events, 20.6, 60.0);
  ASSERT_EQ(events.boxes().size(), 1U);
  EXPECT_EQ(events.boxes().front().min, rock.min);
}

TEST(WorldEvents, NothingFallsOnTheRobotOrItsStart) {
  WorldEvents events({"fall 1 0", "fall 1 10 0 1 4 4 4"});
  for (double t = 0.0; t < 10.0; t += 0.1) events.update(t, {8.0, 0.0, 1.0});
  EXPECT_TRUE(events.boxes().empty());
}

TEST(WorldEvents, PersonWalksBackAlongTheWayAndIsGoneAtItsStart) {
  WorldEvents events({"person 20 10"});
  walk(events, 0.0, 22.0);
  ASSERT_EQ(events.boxes().size(), 1U);
  const double first = events.boxes().front().min.x();
  for (double t = 22.1; t < 25.0; t += 0.1) events.update(t, {22.0, 0.0, 1.0});
  ASSERT_EQ(events.boxes().size(), 1U);
  EXPECT_NEAR(first - events.boxes().front().min.x(), 1.2 * 2.9, 0.4);
  for (double t = 25.0; t < 40.0; t += 0.1) events.update(t, {22.0, 0.0, 1.0});
  EXPECT_TRUE(events.boxes().empty());
}

TEST(WorldEvents, RaysEndThereAndBodiesTouch) {
  WorldEvents events({"fall 0 10 0 1 2 2 2"});
  events.update(0.0, {0.0, 0.0, 1.0});
  std::vector<float> ranges{50.0F, 50.0F, 5.0F};
  events.shorten({0, 0, 1}, {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}}, ranges);
  EXPECT_FLOAT_EQ(ranges[0], 9.0F);
  EXPECT_FLOAT_EQ(ranges[1], 50.0F);
  EXPECT_FLOAT_EQ(ranges[2], 5.0F);
  EXPECT_TRUE(events.touches({8.8, 0.0, 1.0}, {0.7, 0.7, 0.3}));
  EXPECT_FALSE(events.touches({8.5, 0.0, 1.0}, {0.7, 0.7, 0.3}));
}

TEST(WorldEvents, WhatIsNoEventIsRefusedWithTheFormsThereAre) {
  for (const char* text : {"flood 1 2", "fall", "fall 1 2 3", "person x 2", "fall 1 nan"}) {
    try {
      const WorldEvents events({text});
      ADD_FAILURE() << text;
    } catch (const OutsideError& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("person T D"), std::string::npos);
    }
  }
}

TEST(WorldEvents, SimulatedRobotSeesThemAndTouchingOneCounts) {
  SimParams params;
  params.events = {"fall 1 6 0 2 2 4 4"};
  RobotModel robot;
  robot.sensor_models = {SensorModel{}};
  Simulator sim(params, robot, test::boxRoom({30, 30, 6}), {{0.0, 0.0, 2.0}, 0.0}, 1);
  const auto nearest = [&](double until_s) {
    float least = 100.0F;
    for (const SimulatedScan& scan : sim.advanceTo(until_s))
      for (std::size_t k = 0; k < scan.true_ranges.size(); ++k)
        if ((*scan.directions)[k].x() > 0.9F) least = std::min(least, scan.true_ranges[k]);
    return least;
  };
  EXPECT_GT(nearest(0.9), 7.0F);  // the floor; the rock is nearer
  static_cast<void>(sim.advanceTo(1.1));
  EXPECT_LT(nearest(2.0), 6.0F);
  TrajectoryPoint into;
  into.time_s = sim.time() + 5.0;
  into.pose.position = {6.0, 0.0, 2.0};
  sim.follow({into});
  sim.advanceTo(12.0);
  EXPECT_EQ(sim.collisions().episodes, 1);
}

}  // namespace
}  // namespace spelunk::sim
