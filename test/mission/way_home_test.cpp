#include <gtest/gtest.h>

#include "support/scripted_flight.h"

namespace spelunk::mission {
namespace {

using planners::PathKind;
using planners::PlanStatus;
using test::ScriptedFlight;
using test::ScriptedPlanner;

const Pose kStart{{3.0, 2.5, 2.5}, 0.0};
const AxisAlignedBox kBlock{{11.0, 1.0, 1.0}, {11.5, 4.5, 4.0}};

/// Two galleries along x, joined at both ends: y 1..4.5 is flown, y 5.5..9 is seen from both ends.
test::GridWorld twoGalleries() {
  test::GridWorld world({48, 20, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {23.0, 9.0, 4.0}});
  world.block({{7.0, 4.5, 1.0}, {16.0, 5.5, 4.0}});
  return world;
}

/// Flies the first gallery to its end, looks into the second one and comes back; knows no way home.
class CutTrail : public testing::Test {
 protected:
  void SetUp() override {
    setLogSink([this](LogLevel, const std::string& text) { log_.push_back(text); });
    planner_.on_plan = [this](const planners::PlanRequest& request) {
      if (at_ < stops_.size() && (request.pose.position - stops_[at_]).norm() < 0.5) ++at_;
      if (at_ == stops_.size()) return ScriptedPlanner::none(PlanStatus::kNoPath);
      const Eigen::Vector3d way = stops_[at_] - request.pose.position;
      const Eigen::Vector3d next = request.pose.position + std::min(1.0, 4.0 / way.norm()) * way;
      return ScriptedPlanner::path({request.pose, {next, 0.0}}, PathKind::kLocal);
    };
    planner_.on_home = [this](const planners::PlanRequest&) {
      ++home_asked_;
      return ScriptedPlanner::none(PlanStatus::kNoPath);
    };
  }
  void TearDown() override {
    for (const std::string& line : log_)
      EXPECT_NE(line.substr(0, 1), ";") << "a sentence lacks its first half: " << line;
  }
  /// Past all stops; the last one lies beyond `x_min_m`.
  void flyOut(ScriptedFlight& flight, double x_min_m = 17.0) {
    ASSERT_TRUE(flight.start().accepted);
    for (int k = 0; k < 600 && at_ < stops_.size(); ++k) flight.step();
    ASSERT_EQ(at_, stops_.size());
    ASSERT_GT(flight.state().pose.position.x(), x_min_m);
  }
  [[nodiscard]] bool wasSaid(const std::string& text) const {
    return std::any_of(log_.begin(), log_.end(), [&](const std::string& line) {
      return line.find(text) != std::string::npos;
    });
  }

  ScriptedPlanner planner_;
  std::vector<Eigen::Vector3d> stops_{
      {19.0, 2.5, 2.5}, {19.0, 7.0, 2.5}, {19.0, 2.5, 2.5}, {18.0, 2.5, 2.5}};
  std::size_t at_ = 0;
  int home_asked_ = 0;
  std::vector<std::string> log_;
};

TEST_F(CutTrail, RobotComesHomeByAnotherKnownWay) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight);
  flight.world().block(kBlock);
  ASSERT_TRUE(flight.flyToTheEnd(flight.now() + 60.0)) << flight.mission().status().reason;
  EXPECT_LT(distance(flight.state().pose, kStart), 1.0);
  EXPECT_GT(home_asked_, 0) << "the planner is asked first";
  EXPECT_EQ(flight.collisions(), 0);
  EXPECT_TRUE(wasSaid("the way home is cut at (11.")) << flight.mission().status().reason;
}

/// Flies through the first gallery and back through the second one; the planner knows a short way
/// home from there that was only seen.
class SeenWayHome : public CutTrail {
 protected:
  void SetUp() override {
    CutTrail::SetUp();
    stops_ = {{19.0, 2.5, 2.5}, {19.0, 7.0, 2.5}, {8.0, 7.0, 2.5}};
    planner_.on_home = [](const planners::PlanRequest& request) {
      return ScriptedPlanner::path({request.pose, {{5.0, 7.0, 2.5}, 0.0}, kStart}, PathKind::kHome);
    };
  }
  /// Whether the robot comes home the way it flew.
  static bool fliesBack(ScriptedFlight& flight) {
    bool flies_back = false;
    while (flight.mission().status().state != MissionState::kDone && flight.now() < 200.0) {
      flight.step();
      const bool goes_home = flight.mission().status().state == MissionState::kHome;
      flies_back = flies_back || (goes_home && flight.state().pose.position.x() > 17.0);
    }
    EXPECT_LT(distance(flight.state().pose, kStart), 1.0);
    return flies_back;
  }
};

TEST_F(SeenWayHome, IsFlownWhereThereIsTimeToComeBackFromIt) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight, 6.0);
  EXPECT_FALSE(fliesBack(flight));
}

TEST_F(SeenWayHome, IsNotReliedUponAtTheEndOfTheEndurance) {
  MissionParams params;
  params.reserve_s = 2.0;
  params.reserve_percent = 0.0;
  ScriptedFlight flight(twoGalleries(), kStart, planner_, params);
  constexpr double kThereAndBack_s = 41.0;  // along the trail; not enough to try another way first
  flight.setBudget(kThereAndBack_s);
  flyOut(flight, 6.0);
  EXPECT_TRUE(fliesBack(flight));
}

/// What is left is enough for the trail if nothing goes wrong on it, but not on pessimistic times:
/// the way that the promise relies on has to be the one that is flown.
TEST_F(SeenWayHome, IsFlownWhereTheTrailOnlyFitsIfNothingGoesWrong) {
  MissionParams params;
  params.reserve_s = 2.0;
  params.reserve_percent = 0.0;
  params.pessimism = 1.5;
  ScriptedFlight flight(twoGalleries(), kStart, planner_, params);
  flyOut(flight, 6.0);
  constexpr double kTrailWithoutTrouble_s = 22.0;
  flight.setBudget(flight.now() + kTrailWithoutTrouble_s);
  EXPECT_FALSE(fliesBack(flight));
  EXPECT_GT(flight.mission().status().remaining_s, params.reserve_s);
}

TEST_F(CutTrail, AskedHomeFromAStandstillItComesHomeAndSaysNothingByHalves) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight);
  ASSERT_TRUE(flight.mission().pause().accepted);
  flight.flyFor(3.0);
  ASSERT_TRUE(flight.mission().home().accepted);
  EXPECT_TRUE(flight.flyToTheEnd(flight.now() + 60.0)) << flight.mission().status().reason;
}

TEST_F(CutTrail, AnswersThatTakeSecondsAreWaitedFor) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight);
  flight.setPlanTime(2.5);
  flight.world().block(kBlock);
  EXPECT_TRUE(flight.flyToTheEnd(flight.now() + 60.0)) << flight.mission().status().reason;
}

TEST_F(CutTrail, SameSeedGivesTheSameWay) {
  std::vector<double> ends;
  for (int k = 0; k < 2; ++k) {
    at_ = 0;
    ScriptedFlight flight(twoGalleries(), kStart, planner_);
    flyOut(flight);
    flight.world().block(kBlock);
    ASSERT_TRUE(flight.flyToTheEnd(flight.now() + 60.0));
    ends.push_back(flight.now());
    ends.push_back(flight.mission().status().distance_m);
  }
  EXPECT_EQ(ends[0], ends[2]);
  EXPECT_EQ(ends[1], ends[3]);
}

/// The second gallery gets narrower than the robot's box with its margin.
TEST_F(CutTrail, NarrowWayIsFlownWithoutMarginWhereNothingElseIsLeft) {
  RobotModel robot = test::smallRobot();
  robot.box_m = {1.2, 1.2, 0.4};
  test::GridWorld world = twoGalleries();
  world.block({{11.0, 5.5, 1.0}, {12.0, 6.5, 4.0}});
  world.block({{11.0, 7.5, 1.0}, {12.0, 9.0, 4.0}});
  ScriptedFlight flight(world, kStart, planner_, {}, 1, robot);
  flyOut(flight);
  flight.world().block(kBlock);
  EXPECT_TRUE(flight.flyToTheEnd(flight.now() + 60.0)) << flight.mission().status().reason;
  EXPECT_EQ(flight.collisions(), 0);
}

TEST_F(CutTrail, WayIsFlownToWhatIsLeftOfTheTrailWhereHomeItselfHasNoRoom) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight);
  flight.world().block(kBlock);
  flight.world().block({{2.0, 1.0, 1.0}, {3.0, 4.0, 4.0}});  // seen on the way back only
  EXPECT_TRUE(flight.flyToTheEnd(flight.now() + 60.0)) << flight.mission().status().reason;
  EXPECT_EQ(flight.collisions(), 0);
  EXPECT_LE(distance(flight.state().pose, kStart), 1.0);
}

TEST_F(CutTrail, TrulyCutOffItSaysWhereAndGoesOnTryingUntilTheBlockIsGone) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight);
  flight.world().block({{11.0, 1.0, 1.0}, {11.5, 9.0, 4.0}});
  flight.flyFor(20.0);  // the second gallery was seen open: it finds the wall there, too
  const int asked = home_asked_;
  const std::size_t said = log_.size();
  flight.flyFor(12.0);
  EXPECT_EQ(flight.mission().status().state, MissionState::kHold);
  EXPECT_GT(home_asked_, asked + 3);
  EXPECT_GT(log_.size(), said) << "still says so";
  EXPECT_NE(flight.mission().status().reason.find("is cut at (11."), std::string::npos)
      << flight.mission().status().reason;
  EXPECT_TRUE(wasSaid("no way round it is known"));
  EXPECT_EQ(flight.collisions(), 0);
  flight.world().carve({{11.0, 5.5, 1.0}, {11.5, 9.0, 4.0}});
  EXPECT_TRUE(flight.flyToTheEnd(flight.now() + 90.0)) << flight.mission().status().reason;
}

TEST_F(CutTrail, NothingIsSearchedWhereTheTrailIsFree) {
  ScriptedFlight flight(twoGalleries(), kStart, planner_);
  flyOut(flight);
  ASSERT_TRUE(flight.mission().home().accepted);
  EXPECT_TRUE(flight.flyToTheEnd(flight.now() + 60.0));
  EXPECT_FALSE(wasSaid("the way home is"));
  EXPECT_EQ(flight.mission().status().state, MissionState::kDone);
}

class WayHomeSearchTest : public testing::Test {
 protected:
  static map::MapParams mapParams() {
    map::MapParams params = test::coarseMap();
    params.range_min_m = 0.0;
    return params;
  }
  void SetUp() override { twoGalleries().enterInto(map_); }
  navigation::NavigationQuery queryTo(const Eigen::Vector3d& goal) {
    navigation::NavigationQuery query;
    query.map = map_.freeze();
    query.start = {{19.0, 2.5, 2.5}, 0.0};
    query.goal = {goal, 0.0};
    query.box = {0.8, 0.8, 0.4};
    query.region = navigation::SearchRegion::kKnown;
    return query;
  }
  map::OccupancyMap map_{mapParams()};
};

TEST_F(WayHomeSearchTest, FirstQueryWithAnAnswerWins) {
  const Eigen::Vector3d in_rock(10.0, 5.0, 2.5);
  WayHomeSearch search;
  search.queries = {queryTo(in_rock), queryTo({10.0, 7.0, 2.5}), queryTo({18.0, 2.5, 2.5})};
  const auto found = findWayHome(search);
  ASSERT_EQ(found.status, PlanStatus::kOk) << found.reason;
  EXPECT_EQ(found.kind, PathKind::kHome);
  EXPECT_EQ(found.path.back().position, Eigen::Vector3d(10.0, 7.0, 2.5));
}

TEST_F(WayHomeSearchTest, RefusalNamesEveryGoal) {
  WayHomeSearch search;
  search.queries = {queryTo({10.0, 5.0, 2.5}), queryTo({11.0, 5.0, 2.5})};
  const auto found = findWayHome(search);
  EXPECT_EQ(found.status, PlanStatus::kNoPath);
  EXPECT_TRUE(found.path.empty());
  EXPECT_NE(found.reason.find("(10.0, 5.0, 2.5)"), std::string::npos) << found.reason;
  EXPECT_NE(found.reason.find("(11.0, 5.0, 2.5)"), std::string::npos) << found.reason;
}

TEST_F(WayHomeSearchTest, SearchWithoutGoalsSaysSo) {
  const WayHomeSearch search;
  const auto found = findWayHome(search);
  EXPECT_EQ(found.status, PlanStatus::kNoPath);
  EXPECT_FALSE(found.reason.empty());
}

}  // namespace
}  // namespace spelunk::mission
