#include <gtest/gtest.h>

#include "support/scripted_flight.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;
using test::ScriptedFlight;
using test::ScriptedPlanner;

/// A robot that tilts, sent along a corridor right above its floor (z = 1).
class Headroom : public testing::Test {
 protected:
  void SetUp() override {
    setLogSink([](LogLevel, const std::string&) {});
    robot_.tilt_room_m = 0.35;  // a voxel of 0.5 m more than its box, at least
    planner_.on_plan = [](const planners::PlanRequest& request) {
      const double ahead = std::min(15.0, request.pose.position.x() + 6.0);
      if (request.pose.position.x() > 14.5)
        return ScriptedPlanner::none(planners::PlanStatus::kNothingToGain);
      return ScriptedPlanner::path({request.pose, {{ahead, 2.5, 1.25}, 0.0}}, PathKind::kLocal);
    };
  }
  /// Flies until past x = 14; notes the lowest height and the highest speed between x = 7 and 11.
  void fly(const test::GridWorld& world) {
    ScriptedFlight flight(world, {{3.0, 2.5, 1.25}, 0.0}, planner_, {}, 1, robot_);
    ASSERT_TRUE(flight.start().accepted);
    for (int k = 0; k < 1500 && flight.state().pose.position.x() < 14.0; ++k) {
      flight.step();
      const Eigen::Vector3d& at = flight.state().pose.position;
      if (at.x() < 7.0 || at.x() > 11.0) continue;
      lowest_m_ = std::min(lowest_m_, at.z());
      fastest_mps_ = std::max(fastest_mps_, flight.state().velocity.norm());
    }
    EXPECT_GT(flight.state().pose.position.x(), 13.9) << flight.mission().status().reason;
    EXPECT_EQ(flight.collisions(), 0);
  }

  RobotModel robot_ = test::smallRobot();
  ScriptedPlanner planner_;
  double lowest_m_ = 1e9;
  double fastest_mps_ = 0.0;
};

TEST_F(Headroom, PathRightAboveTheFloorIsFlownHigherWhereThereIsRoom) {
  fly(test::corridorWorld(20.0));
  EXPECT_GT(lowest_m_, 1.0 + 0.5 * robot_.box_m.z() + robot_.tilt_room_m - 0.05);
  EXPECT_GT(fastest_mps_, 1.5);
}

TEST_F(Headroom, WhereThereIsNoRoomToTiltItFliesSlowly) {
  test::GridWorld world = test::corridorWorld(20.0);
  world.block({{7.0, 1.0, 2.0}, {11.0, 4.0, 4.0}});
  fly(world);
  EXPECT_LE(fastest_mps_, narrowSpeed(robot_) + 0.05);
}

}  // namespace
}  // namespace spelunk::mission
