#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/navigation/swept_path_check.h"
#include "support/scripted_flight.h"

namespace spelunk::mission {
namespace {

using test::ScriptedFlight;

/// A flight that has looked around and stands at its start.
struct Flight {
  explicit Flight(const test::GridWorld& world, const Pose& start = {{3.0, 2.5, 2.5}, 0.0})
      : scripted(world, start, planner) {
    scripted.flyFor(1.0);
  }

  Answer goTo(const Eigen::Vector3d& point, const navigation::NavigationParams& params = {}) {
    Mission& mission = scripted.mission();
    const Answer given = mission.goTo(point, params);
    if (!given.accepted) return given;
    const auto job = mission.takeJob();
    EXPECT_TRUE(job);
    mission.take(run(*job, planner), scripted.now());
    return {status().outcome == GoToOutcome::kUnderway, status().reason};
  }

  /// Until the flight to the point ends; each path that is flown is known free when it is taken.
  GoToStatus flyToItsEnd(double limit_s = 120.0) {
    int commands = scripted.commands();
    while (status().outcome == GoToOutcome::kUnderway && scripted.now() < limit_s) {
      scripted.step();
      if (scripted.commands() == commands || scripted.lastCommand()->path.empty()) continue;
      commands = scripted.commands();
      map::ConfigurationSpace space(0.9 * scripted.mission().robot().box_m,
                                    scripted.mission().map().freeze());
      EXPECT_TRUE(navigation::checkPath(space, scripted.lastCommand()->path, {}, {}).isFree())
          << "at " << scripted.now() << " s";
    }
    return status();
  }

  [[nodiscard]] GoToStatus status() { return scripted.mission().status().go_to; }
  [[nodiscard]] double distanceTo(const Eigen::Vector3d& point) const {
    return (scripted.state().pose.position - point).norm();
  }

  test::ScriptedPlanner planner;
  ScriptedFlight scripted;
};

int replansOf(const GoToStatus& status) {
  return status.replans_obstacle + status.replans_deviation + status.replans_unseen;
}

/// A ring of two corridors, 4 m wide, between x = 1 and 29, y = 1..5 and 11..15.
test::GridWorld ring() {
  test::GridWorld world({60, 32, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {29.0, 5.0, 4.0}});
  world.carve({{1.0, 11.0, 1.0}, {29.0, 15.0, 4.0}});
  world.carve({{1.0, 1.0, 1.0}, {5.0, 15.0, 4.0}});
  world.carve({{25.0, 1.0, 1.0}, {29.0, 15.0, 4.0}});
  return world;
}

TEST(GoTo, FliesToAKnownPointWithoutReplansAndHolds) {
  Flight flight(test::corridorWorld(30.0));
  const Eigen::Vector3d point(10.0, 2.5, 2.5);
  ASSERT_TRUE(flight.goTo(point).accepted);
  EXPECT_EQ(flight.status().outcome, GoToOutcome::kUnderway);
  const GoToStatus end = flight.flyToItsEnd();
  EXPECT_EQ(end.outcome, GoToOutcome::kReached);
  EXPECT_EQ(replansOf(end), 0);
  EXPECT_LT(flight.distanceTo(point), 0.1);
  EXPECT_EQ(flight.scripted.mission().status().state, MissionState::kHold);
  EXPECT_GT(end.ended_s, end.started_s + 3.0);
}

TEST(GoTo, TakesUpMoreOfTheSamePathAsItComesIntoView) {
  Flight flight(test::corridorWorld(60.0));
  const Eigen::Vector3d point(52.0, 2.5, 2.5);  // the map reaches 12 m
  EXPECT_FALSE(flight.scripted.mission().goToPlan());
  ASSERT_TRUE(flight.goTo(point).accepted);
  const auto plan = flight.scripted.mission().goToPlan();
  ASSERT_TRUE(plan);
  EXPECT_LT((plan->path.back().position - point).norm(), 1e-6);
  EXPECT_LT(plan->known_length_m, 0.5 * lengthOf(plan->path));
  const GoToStatus end = flight.flyToItsEnd();
  EXPECT_EQ(end.outcome, GoToOutcome::kReached) << end.reason;
  EXPECT_EQ(replansOf(end), 0) << "more of the same path is no replan";
  EXPECT_GT(flight.scripted.commands(), 2);
  EXPECT_LT(flight.distanceTo(point), 0.1);
}

TEST(GoTo, NewObstacleOnTheWayIsAReplanAroundIt) {
  Flight flight(ring(), {{3.0, 3.0, 2.5}, 0.0});
  const Eigen::Vector3d point(27.0, 3.0, 2.5);
  ASSERT_TRUE(flight.goTo(point).accepted);
  flight.scripted.flyFor(2.0);
  flight.scripted.world().block({{18.0, 1.0, 1.0}, {19.0, 5.0, 4.0}});
  const GoToStatus end = flight.flyToItsEnd();
  EXPECT_EQ(end.outcome, GoToOutcome::kReached) << end.reason;
  EXPECT_GE(end.replans_obstacle, 1);
  EXPECT_EQ(flight.scripted.collisions(), 0);
  EXPECT_LT(flight.distanceTo(point), 0.1);
}

TEST(GoTo, LeavingThePathIsAReplanBackToThePoint) {
  Flight flight(test::corridorWorld(30.0));
  const Eigen::Vector3d point(12.0, 2.5, 2.5);
  ASSERT_TRUE(flight.goTo(point).accepted);
  flight.scripted.flyFor(2.0);
  flight.scripted.push({-1.2, 0.0, 0.0});
  const GoToStatus end = flight.flyToItsEnd();
  EXPECT_EQ(end.outcome, GoToOutcome::kReached) << end.reason;
  EXPECT_EQ(end.replans_deviation, 1);
  EXPECT_EQ(end.replans_obstacle, 0);
  EXPECT_LT(flight.distanceTo(point), 0.1);
}

TEST(GoTo, WallAcrossTheOnlyWayEndsAsUnreachableWithTheNearestPlace) {
  Flight flight(test::corridorWorld(40.0));
  ASSERT_TRUE(flight.goTo({35.0, 2.5, 2.5}).accepted);
  flight.scripted.world().block({{20.0, 0.0, 0.0}, {21.0, 5.0, 5.0}});
  const GoToStatus end = flight.flyToItsEnd();
  EXPECT_EQ(end.outcome, GoToOutcome::kUnreachable);
  EXPECT_FALSE(end.reason.empty());
  EXPECT_EQ(flight.scripted.collisions(), 0);
  ASSERT_TRUE(end.nearest_reachable.has_value());
  EXPECT_GT(end.nearest_reachable->x(), 15.0);
  EXPECT_LT(end.nearest_reachable->x(), 20.0);
  EXPECT_EQ(flight.scripted.mission().status().state, MissionState::kHold);
}

TEST(GoTo, RefusalsSayWhy) {
  Flight flight(test::corridorWorld(30.0));
  const auto refusalOf = [&](const Eigen::Vector3d& point) {
    const Answer answer = flight.goTo(point);
    EXPECT_FALSE(answer.accepted);
    EXPECT_FALSE(answer.reason.empty());
    return answer.reason;
  };
  EXPECT_NE(refusalOf({10.0, 4.5, 2.5}).find("obstacle"), std::string::npos);
  EXPECT_NE(flight.scripted.mission().mayGoTo({5000.0, 0.0, 0.0}).reason.find("too far"),
            std::string::npos);
  EXPECT_NE(flight.scripted.mission().mayGoTo({NAN, 0.0, 0.0}).reason.find("finite"),
            std::string::npos);
  ASSERT_TRUE(flight.scripted.mission().setBounds({{0, 0, 0}, {20, 5, 5}}).accepted);
  EXPECT_NE(refusalOf({25.0, 2.5, 2.5}).find("bounds"), std::string::npos);
  NoGoZone zone;
  zone.name = "dust";
  zone.polygon = {{12, 0}, {18, 0}, {18, 5}, {12, 5}};
  ASSERT_TRUE(flight.scripted.mission().setZones({zone}).accepted);
  EXPECT_NE(refusalOf({15.0, 2.5, 2.5}).find("no-go"), std::string::npos);
  EXPECT_EQ(flight.status().outcome, GoToOutcome::kUnreachable);
  EXPECT_EQ(flight.scripted.mission().status().distance_m, 0.0) << "nothing was flown";
}

TEST(GoTo, PointFromWhichThereIsNoWayHomeInTimeIsRefused) {
  Flight flight(test::corridorWorld(30.0));
  flight.scripted.setBudget(flight.scripted.now() + 26.0);  // 20 s are the reserve
  flight.scripted.flyFor(0.2);
  const Answer answer = flight.goTo({12.0, 2.5, 2.5});
  EXPECT_FALSE(answer.accepted);
  EXPECT_NE(answer.reason.find("endurance"), std::string::npos) << answer.reason;
}

TEST(GoTo, PauseAbortsIt) {
  Flight flight(test::corridorWorld(30.0));
  ASSERT_TRUE(flight.goTo({12.0, 2.5, 2.5}).accepted);
  flight.scripted.flyFor(1.0);
  EXPECT_TRUE(flight.scripted.mission().pause().accepted);
  flight.scripted.flyFor(0.5);
  EXPECT_EQ(flight.status().outcome, GoToOutcome::kAborted);
  EXPECT_NE(flight.status().reason.find("paused"), std::string::npos);
  EXPECT_TRUE(flight.goTo({12.0, 2.5, 2.5}).accepted) << "and may be asked for again";
}

TEST(GoTo, SameFlightTwiceIsTheSame) {
  const auto fly = [] {
    Flight flight(ring(), {{3.0, 3.0, 2.5}, 0.0});
    EXPECT_TRUE(flight.goTo({27.0, 13.0, 2.5}).accepted);
    EXPECT_EQ(flight.flyToItsEnd().outcome, GoToOutcome::kReached);
    return std::pair(flight.status().ended_s, flight.scripted.mission().trail());
  };
  const auto first = fly();
  const auto second = fly();
  EXPECT_EQ(first.first, second.first);
  ASSERT_EQ(first.second.size(), second.second.size());
  for (std::size_t i = 0; i < first.second.size(); ++i)
    EXPECT_EQ(first.second[i].position, second.second[i].position);
}

}  // namespace
}  // namespace spelunk::mission
