#include "spelunk/mission/mission.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "support/scripted_flight.h"
#include "support/temporary_folder.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;
using planners::PlanStatus;
using test::ScriptedFlight;
using test::ScriptedPlanner;

const Pose kStart{{3.0, 2.5, 2.5}, 0.0};

Path along(double from_x, double to_x) {
  return {{{from_x, 2.5, 2.5}, 0.0}, {{to_x, 2.5, 2.5}, 0.0}};
}

/// Goes on by 6 m along the corridor up to `end_x`, then there is nothing to gain.
class CorridorMission : public testing::Test {
 protected:
  void SetUp() override {
    setLogSink([](LogLevel, const std::string&) {});
    exploreUpTo(20.0);
  }
  void exploreUpTo(double end_x) {
    planner_.on_plan = [end_x](const planners::PlanRequest& request) {
      const Eigen::Vector3d& at = request.pose.position;
      if (at.x() > end_x - 0.5) return ScriptedPlanner::none(PlanStatus::kNothingToGain);
      Path path = along(at.x(), std::min(end_x, at.x() + 6.0));
      path.front() = request.pose;
      return ScriptedPlanner::path(path, PathKind::kLocal);
    };
  }
  ScriptedPlanner planner_;
};

TEST_F(CorridorMission, ExploresThenComesHome) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  ASSERT_TRUE(flight.flyToTheEnd(120.0));
  EXPECT_LT(distance(flight.state().pose, kStart), 1.0);
  EXPECT_NE(flight.mission().status().end_reason.find("explored"), std::string::npos)
      << flight.mission().status().end_reason;
  EXPECT_GT(flight.mission().status().distance_m, 32.0);
  EXPECT_EQ(flight.collisions(), 0);
}

TEST_F(CorridorMission, NeverStopsBetweenLocalPaths) {
  ScriptedFlight flight(test::corridorWorld(60.0), kStart, planner_);
  exploreUpTo(50.0);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(5.0);
  double slowest = 10.0;
  for (int k = 0; k < 150; ++k) {
    flight.step();
    slowest = std::min(slowest, flight.state().velocity.norm());
  }
  EXPECT_GT(slowest, 1.5);
}

TEST_F(CorridorMission, RefusesPathThroughUnknown) {
  planner_.on_plan = [](const planners::PlanRequest& request) {
    Path path{request.pose, {{3.0, 2.5, 9.0}, 0.0}};
    return ScriptedPlanner::path(path, PathKind::kLocal);
  };
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  ASSERT_TRUE(flight.flyToTheEnd(30.0));
  EXPECT_GT(flight.mission().status().refused_paths, 0);
  EXPECT_LT(flight.mission().status().distance_m, 0.5);
  EXPECT_NE(flight.mission().status().end_reason.find("no plan"), std::string::npos);
}

/// Starts so near to a wall that the safety box touches it; the path first leads off by `step_m`.
class StartAtAWall : public CorridorMission {
 protected:
  void leadOffBy(double step_m) {
    planner_.on_plan = [step_m](const planners::PlanRequest& request) {
      if (request.pose.position.x() > 8.0) return ScriptedPlanner::none(PlanStatus::kNothingToGain);
      const double y = request.pose.position.y() < 1.4 ? 1.3 + step_m : request.pose.position.y();
      const Path path{
          request.pose, {{request.pose.position.x(), y, 2.5}, 0.0}, {{10.0, y, 2.5}, 0.0}};
      return ScriptedPlanner::path(path, PathKind::kLocal);
    };
  }
  ScriptedFlight flight_{test::corridorWorld(30.0), {{3.0, 1.3, 2.5}, 0.0}, planner_};
};

TEST_F(StartAtAWall, ShortStepAwayFromItIsFlown) {
  leadOffBy(0.6);
  ASSERT_TRUE(flight_.start().accepted);
  flight_.flyFor(8.0);
  EXPECT_GT(flight_.state().pose.position.x(), 5.0);
  EXPECT_EQ(flight_.collisions(), 0);
}

TEST_F(StartAtAWall, PathThatKeepsTouchingItIsRefused) {
  leadOffBy(0.05);
  ASSERT_TRUE(flight_.start().accepted);
  flight_.flyFor(8.0);
  EXPECT_LT(flight_.state().pose.position.x(), 3.5);
  EXPECT_GT(flight_.mission().status().refused_paths, 0);
}

TEST_F(StartAtAWall, LongStepAwayFromItIsRefused) {
  leadOffBy(0.9);
  ASSERT_TRUE(flight_.start().accepted);
  flight_.flyFor(8.0);
  EXPECT_LT(flight_.state().pose.position.x(), 3.5);
  EXPECT_GT(flight_.mission().status().refused_paths, 0);
}

TEST_F(CorridorMission, RefusesPathOutsideTheBounds) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  AxisAlignedBox bounds;
  bounds.max.x() = 8.0;
  ASSERT_TRUE(flight.mission().setBounds(bounds).accepted);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(20.0);
  EXPECT_LE(flight.state().pose.position.x(), 8.0);
  EXPECT_NE(flight.mission().status().refused_paths, 0);
}

TEST_F(CorridorMission, RefusesPathThroughNoGoZoneAndNamesIt) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  NoGoZone zone;
  zone.name = "old stope";
  zone.polygon = {{6.0, 0.0}, {7.0, 0.0}, {7.0, 5.0}, {6.0, 5.0}};
  ASSERT_TRUE(flight.mission().setZones({zone}).accepted);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(3.0);
  EXPECT_LT(flight.state().pose.position.x(), 5.7);
  EXPECT_NE(flight.mission().status().end_reason.find("old stope"), std::string::npos);
}

TEST_F(CorridorMission, TurnsForHomeWhenTheWayHomeTakesWhatIsLeft) {
  exploreUpTo(90.0);
  ScriptedFlight flight(test::corridorWorld(100.0), kStart, planner_);
  flight.setBudget(70.0);
  ASSERT_TRUE(flight.start().accepted);
  ASSERT_TRUE(flight.flyToTheEnd(70.0));
  EXPECT_GE(flight.mission().status().remaining_s, 15.0);
  EXPECT_LE(flight.mission().status().remaining_s, 40.0);
  EXPECT_NE(flight.mission().status().end_reason.find("endurance"), std::string::npos);
}

/// At the far end nothing is affordable; half the way back something is.
class AffordableAgain : public CorridorMission {
 protected:
  void SetUp() override {
    CorridorMission::SetUp();
    planner_.on_plan = [this](const planners::PlanRequest& request) {
      const double x = request.pose.position.x();
      was_at_end_ = was_at_end_ || x > 19.5;
      if (was_at_end_ && (looked_again_ || x > 12.0))
        return ScriptedPlanner::none(PlanStatus::kBudgetSaysHome);
      looked_again_ = was_at_end_;
      Path path = along(x, std::min(20.0, x + 4.0));
      path.front() = request.pose;
      return ScriptedPlanner::path(path, PathKind::kLocal);
    };
    planner_.on_home = [](const planners::PlanRequest& request) {
      return ScriptedPlanner::path({request.pose, kStart}, PathKind::kHome);
    };
  }
  /// Whether the robot explored again after it had turned for home.
  bool exploresOnTheWayHome(ScriptedFlight& flight) {
    bool was_going_home = false;
    bool explores = false;
    while (flight.mission().status().state != MissionState::kDone && flight.now() < 120.0) {
      flight.step();
      was_going_home = was_going_home || flight.mission().status().state == MissionState::kHome;
      explores =
          explores || (was_going_home && flight.mission().status().state == MissionState::kExplore);
    }
    return explores;
  }
  static RobotModel slowRobot() {
    RobotModel slow = test::smallRobot();
    slow.speed_max_mps = 0.5;  // some looks fit on the way
    return slow;
  }
  bool was_at_end_ = false;
  bool looked_again_ = false;
};

TEST_F(AffordableAgain, OnTheWayHomeWhatCameIntoReachIsExplored) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_, {}, 1, slowRobot());
  ASSERT_TRUE(flight.start().accepted);
  EXPECT_TRUE(exploresOnTheWayHome(flight));
  EXPECT_EQ(flight.mission().status().state, MissionState::kDone);
  EXPECT_LT(distance(flight.state().pose, kStart), 1.0);
  EXPECT_NE(flight.mission().status().end_reason.find("endurance"), std::string::npos);
}

TEST_F(AffordableAgain, NotWhatLeavesNoWayHome) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_, {}, 1, slowRobot());
  planner_.on_home = [](const planners::PlanRequest& request) {
    // From where the robot would turn round, home is far.
    const bool is_far = request.pose.yaw == 0.0 && request.pose.position.x() > 12.0;
    return is_far ? ScriptedPlanner::none(PlanStatus::kNoPath)
                  : ScriptedPlanner::path({request.pose, kStart}, PathKind::kHome);
  };
  ASSERT_TRUE(flight.start().accepted);
  EXPECT_FALSE(exploresOnTheWayHome(flight));
  EXPECT_EQ(flight.mission().status().state, MissionState::kDone);
}

TEST_F(CorridorMission, StopsBeforeNewObstacleAndSaysWhy) {
  exploreUpTo(25.0);
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(3.0);
  const double x = flight.state().pose.position.x();
  flight.world().block({{x + 4.0, 0.5, 0.5}, {x + 4.5, 4.5, 4.5}});
  bool said = false;
  for (int k = 0; k < 100; ++k) {
    flight.step();
    said = said || flight.mission().status().reason.find("obstacle") != std::string::npos;
  }
  EXPECT_TRUE(said);
  EXPECT_EQ(flight.collisions(), 0);
  EXPECT_GE(flight.mission().status().replans_obstacle + flight.mission().status().refused_paths,
            1);
  EXPECT_TRUE(flight.flyToTheEnd(90.0));
}

TEST_F(CorridorMission, HoldsWhenTheWayHomeIsWalledUpAndSaysSo) {
  exploreUpTo(12.0);
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(4.5);
  flight.world().block({{5.0, 0.5, 0.5}, {5.5, 4.5, 4.5}});
  flight.flyFor(20.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_NE(flight.mission().status().reason.find("home"), std::string::npos);
  EXPECT_EQ(flight.collisions(), 0);
  flight.world().carve({{5.0, 1.0, 1.0}, {5.5, 4.0, 4.0}});
  EXPECT_TRUE(flight.flyToTheEnd(90.0)) << flight.mission().status().reason;
}

TEST_F(CorridorMission, DeviationHoldsAndPlansAnew) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(3.0);
  flight.push({0.0, 0.0, 0.95});
  flight.flyFor(0.3);
  EXPECT_EQ(flight.mission().status().replans_deviation, 1);
  EXPECT_TRUE(flight.flyToTheEnd(120.0));
}

TEST_F(CorridorMission, EmergencyStopStaysUntilStart) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(3.0);
  flight.mission().emergencyStop();
  flight.step();
  EXPECT_TRUE(flight.lastCommand()->path.empty());
  const double x = flight.state().pose.position.x();
  flight.flyFor(5.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kEStop);
  EXPECT_FALSE(flight.mission().home().accepted);
  EXPECT_EQ(flight.state().pose.position.x(), x);
  EXPECT_TRUE(flight.mission().start().accepted);
  EXPECT_TRUE(flight.flyToTheEnd(120.0));
}

TEST_F(CorridorMission, PauseHoldsAndStartGoesOn) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(3.0);
  EXPECT_TRUE(flight.mission().pause().accepted);
  flight.flyFor(3.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_TRUE(flight.mission().start().accepted);
  EXPECT_TRUE(flight.flyToTheEnd(120.0));
}

TEST_F(CorridorMission, HomeAsAskedEndsAtHome) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(4.0);
  EXPECT_TRUE(flight.mission().home().accepted);
  EXPECT_TRUE(flight.flyToTheEnd(60.0));
  EXPECT_EQ(flight.mission().status().end_reason, "home as asked");
}

TEST_F(CorridorMission, SameSeedGivesTheSameCommands) {
  std::vector<double> ends;
  for (int k = 0; k < 2; ++k) {
    ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
    ASSERT_TRUE(flight.start().accepted);
    ASSERT_TRUE(flight.flyToTheEnd(120.0));
    ends.push_back(flight.now());
    ends.push_back(flight.mission().status().distance_m);
  }
  EXPECT_EQ(ends[0], ends[2]);
  EXPECT_EQ(ends[1], ends[3]);
}

TEST_F(CorridorMission, SavesAndTakesUpAgain) {
  const test::TemporaryFolder folder;
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(5.0);
  const Answer saved = flight.mission().save(folder.at("m"), {});
  ASSERT_TRUE(saved.accepted) << saved.reason;
  ScriptedFlight later(test::corridorWorld(30.0), flight.state().pose, planner_);
  planners::PlannerGraph graph;
  const Answer loaded = later.mission().load(folder.at("m"), &graph);
  ASSERT_TRUE(loaded.accepted) << loaded.reason;
  EXPECT_EQ(later.mission().trail().size(), flight.mission().trail().size());
  ASSERT_TRUE(later.start().accepted);
  EXPECT_TRUE(later.mission().home().accepted);
  ASSERT_TRUE(later.flyToTheEnd(60.0));
  EXPECT_LT(distance(later.state().pose, kStart), 1.0);
}

TEST_F(CorridorMission, EnduranceIsKeptOverSavingAndLoading) {
  const test::TemporaryFolder folder;
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(8.0);
  const double left_s = flight.mission().status().remaining_s;
  ASSERT_LT(left_s, flight.mission().robot().endurance_s - 7.0);
  ASSERT_TRUE(flight.mission().save(folder.at("m"), {}).accepted);

  ScriptedFlight away(test::corridorWorld(30.0), flight.state().pose, planner_);
  ASSERT_TRUE(away.mission().load(folder.at("m"), nullptr).accepted);
  ASSERT_TRUE(away.start().accepted);
  away.flyFor(1.0);
  EXPECT_LE(away.mission().status().remaining_s, left_s);
  EXPECT_GT(away.mission().status().remaining_s, left_s - 3.0);

  ScriptedFlight at_home(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(at_home.mission().load(folder.at("m"), nullptr).accepted);
  ASSERT_TRUE(at_home.start().accepted);
  at_home.flyFor(1.0);
  EXPECT_GT(at_home.mission().status().remaining_s, left_s + 5.0) << "a robot at home can recharge";
}

TEST_F(CorridorMission, PathThatNobodyCarriesOutIsNeverTakenForExplored) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  flight.ignoreCommands();
  ASSERT_TRUE(flight.start().accepted);
  bool said = false;
  for (int k = 0; k < 400; ++k) {
    flight.step();
    said = said ||
           flight.mission().status().reason.find("does not follow its path") != std::string::npos;
    ASSERT_NE(flight.mission().status().state, MissionState::kDone)
        << flight.mission().status().end_reason;
  }
  EXPECT_TRUE(said);
  for (const planners::PathReport& report : planner_.reports)
    EXPECT_TRUE(report.outcome == planners::PathOutcome::kNone ||
                report.outcome == planners::PathOutcome::kReplaced)
        << "nobody has flown there: " << report.reason;
  flight.obeyCommands();
  EXPECT_TRUE(flight.flyToTheEnd(200.0)) << flight.mission().status().reason;
  EXPECT_GT(flight.mission().status().distance_m, 32.0);
}

TEST_F(CorridorMission, PathThatNobodyCarriesOutEndsNoWayHomeAndNoFlightToAPoint) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(5.0);
  ASSERT_TRUE(flight.mission().home().accepted);
  flight.flyFor(1.0);
  ASSERT_TRUE(flight.mission().pause().accepted);
  flight.flyFor(4.0);
  flight.ignoreCommands();
  ASSERT_TRUE(flight.mission().home().accepted);
  flight.flyFor(20.0);
  EXPECT_EQ(flight.mission().status().end_reason, "home as asked");
  EXPECT_NE(flight.mission().status().state, MissionState::kDone);
  flight.obeyCommands();
  EXPECT_TRUE(flight.flyToTheEnd(90.0)) << flight.mission().status().reason;
}

TEST_F(CorridorMission, LookingAtPlansInBetweenChangesNothing) {
  std::vector<double> ends;
  for (const bool looks : {false, true}) {
    ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
    ASSERT_TRUE(flight.start().accepted);
    while (flight.mission().status().state != MissionState::kDone && flight.now() < 120.0) {
      flight.step();
      if (!looks) continue;
      const auto request = flight.mission().requestHere(flight.now());
      ASSERT_TRUE(request);
      static_cast<void>(planner_.plan(*request));
    }
    ends.push_back(flight.now());
    ends.push_back(flight.mission().status().distance_m);
  }
  EXPECT_EQ(ends[0], ends[2]);
  EXPECT_EQ(ends[1], ends[3]);
}

/// Starts so near to the floor that the safety box touches it.
class StartOnTheFloor : public CorridorMission, public testing::WithParamInterface<double> {
 protected:
  void SetUp() override {
    CorridorMission::SetUp();
    planner_.on_plan = [](const planners::PlanRequest& request) {
      if (request.pose.position.x() > 15.0)
        return ScriptedPlanner::none(PlanStatus::kNothingToGain);
      Path path{request.pose, request.pose};
      path.back().position.x() += 6.0;
      return ScriptedPlanner::path(path, PathKind::kLocal);
    };
  }
};

TEST_P(StartOnTheFloor, TakesOffExploresComesHomeAndLands) {
  const Pose stand{{3.0, 2.5, 1.0 + GetParam()}, 0.0};
  ScriptedFlight flight(test::corridorWorld(30.0), stand, planner_);
  ASSERT_TRUE(flight.start().accepted) << flight.mission().status().reason;
  EXPECT_EQ(flight.mission().status().state, MissionState::kTakeOff);
  double highest_m = 0.0;
  bool landed = false;
  while (flight.mission().status().state != MissionState::kDone && flight.now() < 120.0) {
    flight.step();
    highest_m = std::max(highest_m, flight.state().pose.position.z());
    landed = landed || flight.mission().status().state == MissionState::kLand;
  }
  ASSERT_EQ(flight.mission().status().state, MissionState::kDone)
      << flight.mission().status().reason;
  EXPECT_GT(highest_m, stand.position.z() + 0.3);
  EXPECT_GT(flight.mission().status().distance_m, 20.0) << flight.mission().status().end_reason;
  EXPECT_TRUE(landed);
  EXPECT_LT(distance(flight.state().pose, stand), 0.3);
}

INSTANTIATE_TEST_SUITE_P(Heights, StartOnTheFloor, testing::Values(0.12, 0.18));

TEST_F(CorridorMission, StartAfterTheEndLeadsToOneEndMore) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  ASSERT_TRUE(flight.flyToTheEnd(120.0));
  planner_.on_plan = [](const planners::PlanRequest&) {
    return ScriptedPlanner::none(planners::PlanStatus::kNothingToGain);
  };
  int changes = 0;
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(flight.mission().start().accepted);
    MissionState last = flight.mission().status().state;
    for (int k = 0; k < 200; ++k) {
      flight.step();
      changes += flight.mission().status().state != last ? 1 : 0;
      last = flight.mission().status().state;
    }
    EXPECT_EQ(last, MissionState::kDone);
  }
  EXPECT_LE(changes, 6);
}

TEST_F(CorridorMission, KnowsWhereItIsBetweenReportsThatComeSeldom) {
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  flight.reportEvery(0.5);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(15.0);
  EXPECT_EQ(flight.mission().status().replans_deviation, 0);
  EXPECT_GT(flight.mission().status().distance_m, 5.0);
}

TEST_F(CorridorMission, FliesAsSlowlyAsReportsOfItsPlaceAreSlow) {
  std::string said;
  setLogSink([&](LogLevel, const std::string& text) { said += text + "\n"; });
  ScriptedFlight flight(test::corridorWorld(40.0), kStart, planner_);
  flight.reportEvery(1.2);
  double fastest_mps = 0.0;
  flight.flyFor(5.0);
  ASSERT_TRUE(flight.start().accepted);
  for (int k = 0; k < 150; ++k) {
    flight.step();
    fastest_mps = std::max(fastest_mps, flight.state().velocity.norm());
  }
  EXPECT_EQ(flight.mission().status().replans_deviation, 0);
  EXPECT_GT(flight.mission().status().distance_m, 3.0);
  EXPECT_LT(fastest_mps, 0.8 / 1.2 + 0.01);  // deviation_max_m in a period
  EXPECT_NE(said.find("times a second or more often"), std::string::npos) << said;
  setLogSink([](LogLevel, const std::string&) {});
}

TEST_F(CorridorMission, HoldsWhereTooFewRaysComeBackAndSaysHowMany) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(2.0);
  flight.thinScans(2);
  flight.flyFor(4.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_NE(flight.mission().status().reason.find("too few returns to fly by: 2 of the 3600 rays"),
            std::string::npos)
      << flight.mission().status().reason;
  const double x = flight.state().pose.position.x();
  flight.flyFor(5.0);
  EXPECT_EQ(flight.state().pose.position.x(), x);
  flight.thinScans(std::numeric_limits<std::size_t>::max());
  flight.flyFor(6.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kExplore)
      << flight.mission().status().reason;
  EXPECT_GT(flight.state().pose.position.x(), x + 1.0);
}

TEST_F(CorridorMission, FliesOnWhereMostRaysMeetNothing) {
  ScriptedFlight flight(test::corridorWorld(30.0), kStart, planner_);
  ASSERT_TRUE(flight.start().accepted);
  flight.flyFor(2.0);
  flight.thinScans(360);  // a tenth of the rays: a wide hall, a portal
  flight.flyFor(4.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kExplore)
      << flight.mission().status().reason;
}

}  // namespace
}  // namespace spelunk::mission
