#include "spelunk/navigation/navigator.h"

#include <gtest/gtest.h>

#include <limits>

#include "spelunk/common/contract.h"
#include "spelunk/navigation/swept_path_check.h"
#include "support/grid_world.h"

namespace spelunk::navigation {
namespace {

const Eigen::Vector3d kBox(0.8, 0.8, 0.4);

map::OccupancyMap emptyMap() {
  map::MapParams params;
  params.resolution_m = 0.25;
  params.range_min_m = 0.0;
  return map::OccupancyMap(params);
}

/// Two halls joined by a door at the far end, all of it known.
std::shared_ptr<const map::FrozenMap> twoHalls() {
  test::GridWorld world({40, 30, 8}, 0.5);
  world.carve({{0.5, 0.5, 0.5}, {19.5, 6.5, 3.5}});
  world.carve({{0.5, 7.5, 0.5}, {19.5, 14.5, 3.5}});
  world.carve({{16.0, 6.0, 0.5}, {18.5, 8.0, 3.5}});
  map::OccupancyMap map = emptyMap();
  world.enterInto(map);
  return map.freeze();
}

/// A free hall in unknown space, nothing occupied.
std::shared_ptr<const map::FrozenMap> hallInTheUnknown() {
  map::OccupancyMap map = emptyMap();
  map.markFree({{0.0, 0.0, 0.0}, {10.0, 6.0, 3.0}});
  return map.freeze();
}

NavigationQuery acrossTheHalls() {
  static const auto kMap = twoHalls();
  NavigationQuery query;
  query.map = kMap;
  query.start = {{2.0, 3.0, 2.0}, 0.0};
  query.goal = {{2.0, 11.0, 2.0}, 1.0};
  query.box = kBox;
  query.rng = Rng(11);
  return query;
}

NavigationQuery outOfTheHall() {
  static const auto kMap = hallInTheUnknown();
  NavigationQuery query;
  query.map = kMap;
  query.start = {{2.0, 3.0, 1.5}, 0.0};
  query.goal = {{25.0, 3.0, 1.5}, 0.0};
  query.box = kBox;
  query.rng = Rng(5);
  return query;
}

Navigator navigator(const std::string& method = "adaptive", double safe_distance_m = 0.2) {
  NavigationParams params;
  params.method = method;
  params.safe_distance_m = safe_distance_m;
  return Navigator(params);
}

bool isKnownFree(const NavigationQuery& query, const Path& path, const Eigen::Vector3d& box) {
  map::ConfigurationSpace space(box, query.map);
  return checkPath(space, path, {}, {}).isFree();
}

TEST(Navigator, FindsTheDoorInKnownSpace) {
  const NavigationQuery query = acrossTheHalls();
  const NavigationAnswer answer = navigator().plan(query);
  ASSERT_EQ(answer.status, NavigationStatus::kOk) << answer.reason;
  EXPECT_EQ(answer.path.front().position, query.start.position);
  EXPECT_EQ(answer.path.back().position, query.goal.position);
  EXPECT_EQ(answer.path.back().yaw, 1.0);
  EXPECT_TRUE(isKnownFree(query, answer.path, query.box));
  EXPECT_NEAR(answer.known_length_m, lengthOf(answer.path), 1e-9);
  EXPECT_LT(lengthOf(answer.path), 40.0);  // the shortest is about 36
}

TEST(Navigator, SameQuestionGivesTheSameAnswerFromAFreshNavigatorAndFromAUsedOne) {
  Navigator used = navigator();
  const NavigationAnswer first = used.plan(acrossTheHalls());
  NavigationQuery other = acrossTheHalls();
  other.goal.position.x() = 6.0;
  static_cast<void>(used.plan(other));
  for (const NavigationAnswer& again :
       {used.plan(acrossTheHalls()), navigator().plan(acrossTheHalls())}) {
    ASSERT_EQ(again.path.size(), first.path.size());
    EXPECT_EQ(again.iterations, first.iterations);
    for (std::size_t i = 0; i < first.path.size(); ++i)
      EXPECT_EQ(again.path[i].position, first.path[i].position);
  }
}

TEST(Navigator, StraightLineNeedsNoTrees) {
  NavigationQuery query = acrossTheHalls();
  query.goal = {{8.0, 3.0, 2.0}, 0.0};
  query.trees = TreeDetail::kKeep;
  const NavigationAnswer answer = navigator().plan(query);
  EXPECT_EQ(answer.path.size(), 2U);
  EXPECT_EQ(answer.iterations, 0);
  EXPECT_TRUE(answer.trees.vertices.empty());
}

TEST(Navigator, PathKeepsTheSafeDistanceAwayFromItsEnds) {
  const NavigationQuery query = acrossTheHalls();
  const NavigationAnswer answer = navigator("adaptive", 0.4).plan(query);
  ASSERT_EQ(answer.status, NavigationStatus::kOk);
  EXPECT_EQ(answer.safe_distance_m, 0.4);
  const Path inner = slice(answer.path, 1.0, lengthOf(answer.path) - 1.0);
  const Eigen::Vector3d grown = kBox + Eigen::Vector3d::Constant(0.8);
  EXPECT_TRUE(isKnownFree(query, inner, grown));
}

TEST(Navigator, NarrowDoorIsTakenWithoutTheSafeDistance) {
  const NavigationAnswer answer = navigator("adaptive", 1.0).plan(acrossTheHalls());
  ASSERT_EQ(answer.status, NavigationStatus::kOk) << answer.reason;
  EXPECT_EQ(answer.safe_distance_m, 0.0);
}

TEST(Navigator, UnknownGoalIsReachedThroughTheUnknownAndOnlyTheKnownPartCountsAsKnown) {
  const NavigationAnswer answer = navigator().plan(outOfTheHall());
  ASSERT_EQ(answer.status, NavigationStatus::kOk) << answer.reason;
  EXPECT_NEAR(answer.known_length_m, 10.0 - 0.4 - 2.0, 0.3);  // the box stays in the hall
  EXPECT_GT(lengthOf(answer.path), 22.9);
}

TEST(Navigator, AdaptiveStaysInKnownSpaceWhereThePlainOneCutsThroughTheUnknown) {
  map::OccupancyMap map = emptyMap();  // a known U
  map.markFree({{0.0, 0.0, 0.0}, {3.0, 15.0, 3.0}});
  map.markFree({{0.0, 12.0, 0.0}, {15.0, 15.0, 3.0}});
  map.markFree({{12.0, 0.0, 0.0}, {15.0, 15.0, 3.0}});
  NavigationQuery query;
  query.map = map.freeze();
  query.start = {{1.5, 1.5, 1.5}, 0.0};
  query.goal = {{13.5, 1.5, 1.5}, 0.0};
  query.box = kBox;
  query.rng = Rng(3);
  const NavigationAnswer adaptive = navigator("adaptive").plan(query);
  const NavigationAnswer plain = navigator("plain_short").plan(query);
  ASSERT_EQ(adaptive.status, NavigationStatus::kOk);
  ASSERT_EQ(plain.status, NavigationStatus::kOk);
  EXPECT_NEAR(adaptive.known_length_m, lengthOf(adaptive.path), 1e-9);
  EXPECT_GT(lengthOf(adaptive.path), 30.0);
  EXPECT_NEAR(lengthOf(plain.path), 12.0, 1e-9);
  EXPECT_LT(plain.known_length_m, 2.0);
}

TEST(Navigator, PlainTakesTheTreesAsTheyAre) {
  const NavigationQuery query = acrossTheHalls();
  const NavigationAnswer plain = navigator("plain").plan(query);
  const NavigationAnswer shortened = navigator("plain_short").plan(query);
  ASSERT_EQ(plain.status, NavigationStatus::kOk);
  ASSERT_EQ(shortened.status, NavigationStatus::kOk);
  EXPECT_GT(lengthOf(plain.path), 1.1 * lengthOf(shortened.path));
  for (std::size_t i = 1; i < plain.path.size(); ++i)
    EXPECT_LE(distance(plain.path[i - 1], plain.path[i]), 1.0 + 1e-9) << "one extension";
}

TEST(Navigator, TreesHoldTheStartAndEachEdgeIsFree) {
  NavigationQuery query = acrossTheHalls();
  query.trees = TreeDetail::kKeep;
  const NavigationAnswer answer = navigator("adaptive", 0.0).plan(query);
  ASSERT_GT(answer.trees.edges.size(), 3U);
  map::ConfigurationSpace space(query.box, query.map);
  bool has_start = false;
  for (const Eigen::Vector3d& vertex : answer.trees.vertices)
    has_start = has_start || vertex == query.start.position;
  EXPECT_TRUE(has_start);
  for (const auto& [a, b] : answer.trees.edges)
    EXPECT_TRUE(space.isSweepFree(answer.trees.vertices[a], answer.trees.vertices[b]) ||
                space.isSweepFree(answer.trees.vertices[b], answer.trees.vertices[a]));
}

TEST(Navigator, UnreachableGoalGivesTheReasonAndTheNearestReachablePlace) {
  NavigationQuery query = acrossTheHalls();
  query.bounds.max.x() = 15.0;  // the door lies outside
  NavigationParams params;
  params.iterations = 600;
  const NavigationAnswer answer = Navigator(params).plan(query);
  EXPECT_EQ(answer.status, NavigationStatus::kNoPath);
  EXPECT_TRUE(answer.path.empty());
  EXPECT_LE(answer.iterations, 600 + 4);
  EXPECT_NE(answer.reason.find("no path"), std::string::npos);
  ASSERT_TRUE(answer.nearest_reachable.has_value());
  EXPECT_TRUE(map::ConfigurationSpace(query.box, query.map).isFree(*answer.nearest_reachable));
  EXPECT_NEAR(answer.nearest_reachable->y(), 6.1, 1.5);  // at the wall between the halls
  EXPECT_LT(answer.nearest_reachable->y(), 6.2);
}

TEST(Navigator, EachRefusalHasItsStatusAndReason) {
  const auto statusOf = [](const NavigationQuery& query) {
    const NavigationAnswer answer = navigator().plan(query);
    EXPECT_FALSE(answer.reason.empty());
    EXPECT_TRUE(answer.path.empty());
    return answer.status;
  };
  NavigationQuery query = acrossTheHalls();
  query.goal.position.y() = 7.0;  // inside the wall
  EXPECT_EQ(statusOf(query), NavigationStatus::kGoalBlocked);
  query = acrossTheHalls();
  query.start.position.z() = -5.0;
  EXPECT_EQ(statusOf(query), NavigationStatus::kStartBlocked);
  query = acrossTheHalls();
  query.bounds.max.y() = 8.0;
  EXPECT_EQ(statusOf(query), NavigationStatus::kOutOfBounds);
  query = acrossTheHalls();
  NoGoZone zone;
  zone.name = "around the goal";
  zone.polygon = {{0.0, 9.0}, {4.0, 9.0}, {4.0, 13.0}, {0.0, 13.0}};
  query.zones = {zone};
  EXPECT_EQ(statusOf(query), NavigationStatus::kNoGo);
  query = outOfTheHall();
  query.region = SearchRegion::kKnown;
  EXPECT_EQ(statusOf(query), NavigationStatus::kGoalUnknown);
}

TEST(Navigator, StartThatTouchesAnObstacleIsLeftByAShortStep) {
  NavigationQuery query = acrossTheHalls();
  query.start.position.y() = 0.8;  // the box reaches 0.1 m into the wall
  const NavigationAnswer answer = navigator().plan(query);
  ASSERT_EQ(answer.status, NavigationStatus::kOk) << answer.reason;
  EXPECT_EQ(answer.path.front().position, query.start.position);
  EXPECT_LE(distance(answer.path[0], answer.path[1]), 0.6 + 1e-9);
  const Path rest(answer.path.begin() + 1, answer.path.end());
  EXPECT_TRUE(isKnownFree(query, rest, query.box));
}

/// A block of rock in a known hall; left of it the way is shorter.
NavigationQuery aroundABlock() {
  test::GridWorld world({50, 40, 8}, 0.5);
  world.carve({{0.5, 0.5, 0.5}, {24.5, 19.5, 3.5}});
  world.block({{4.0, 8.0, 0.0}, {20.0, 12.0, 4.0}});
  map::OccupancyMap map = emptyMap();
  world.enterInto(map);
  NavigationQuery query;
  query.map = map.freeze();
  query.start = {{9.0, 4.0, 2.0}, 0.0};
  query.goal = {{9.0, 16.0, 2.0}, 0.0};
  query.box = kBox;
  query.region = SearchRegion::kKnown;
  return query;
}

Navigator rrtStar(int iterations) {
  NavigationParams params;
  params.method = "rrt_star";
  params.safe_distance_m = 0.0;
  params.iterations = iterations;
  return Navigator(params);
}

TEST(RrtStar, WayIsFreeAndRepeats) {
  const NavigationQuery query = acrossTheHalls();
  Navigator used = rrtStar(3000);
  const NavigationAnswer first = used.plan(query);
  ASSERT_EQ(first.status, NavigationStatus::kOk) << first.reason;
  EXPECT_TRUE(isKnownFree(query, first.path, query.box));
  EXPECT_LT(lengthOf(first.path), 37.0);  // the shortest is about 36
  for (const NavigationAnswer& again : {used.plan(query), rrtStar(3000).plan(query)}) {
    ASSERT_EQ(again.path.size(), first.path.size());
    for (std::size_t i = 0; i < first.path.size(); ++i)
      EXPECT_EQ(again.path[i].position, first.path[i].position);
  }
}

TEST(RrtStar, WaysAreNotLongerThanThoseOfRrtConnectAndTakeTheShorterSide) {
  NavigationQuery query = aroundABlock();
  constexpr double kShorterSide_m = 18.6;  // round the left end; the right one takes 30 m
  int longer_side_by_connect = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    query.rng = Rng(seed);
    const NavigationAnswer star = rrtStar(2500).plan(query);
    const NavigationAnswer connect = navigator("adaptive", 0.0).plan(query);
    ASSERT_EQ(star.status, NavigationStatus::kOk) << star.reason;
    ASSERT_EQ(connect.status, NavigationStatus::kOk) << connect.reason;
    EXPECT_LT(lengthOf(star.path), kShorterSide_m * 1.05) << "seed " << seed;
    EXPECT_LT(lengthOf(star.path), lengthOf(connect.path) * 1.02) << "seed " << seed;
    longer_side_by_connect += lengthOf(connect.path) > 1.3 * kShorterSide_m ? 1 : 0;
  }
  EXPECT_GT(longer_side_by_connect, 0) << "the world does not tell the methods apart";
}

TEST(RrtStar, MoreIterationsNeverMakeTheWayLonger) {
  NavigationQuery query = acrossTheHalls();
  query.region = SearchRegion::kKnown;
  double last = 1e9;
  for (const int iterations : {1500, 6000}) {
    const NavigationAnswer answer = rrtStar(iterations).plan(query);
    ASSERT_EQ(answer.status, NavigationStatus::kOk) << answer.reason;
    EXPECT_NEAR(answer.iterations, iterations, 4);
    EXPECT_LT(lengthOf(answer.path), last * 1.01);
    last = lengthOf(answer.path);
  }
}

TEST(RrtStar, StopsAtItsIterationsWhereThereIsNoWay) {
  NavigationQuery query = acrossTheHalls();
  query.bounds.max.x() = 15.0;  // the door lies outside
  const NavigationAnswer answer = rrtStar(800).plan(query);
  EXPECT_EQ(answer.status, NavigationStatus::kNoPath);
  EXPECT_LE(answer.iterations, 800 + 4);
  ASSERT_TRUE(answer.nearest_reachable.has_value());
  EXPECT_NEAR(answer.nearest_reachable->y(), 6.1, 1.5);
}

TEST(Navigator, BadQueriesBreakTheContract) {
  NavigationQuery query = acrossTheHalls();
  query.map.reset();
  EXPECT_THROW(static_cast<void>(navigator().plan(query)), Precondition);
  query = acrossTheHalls();
  query.goal.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(navigator().plan(query)), Precondition);
  query = acrossTheHalls();
  query.box.x() = 0.0;
  EXPECT_THROW(static_cast<void>(navigator().plan(query)), Precondition);
  EXPECT_THROW(navigator("astar"), Precondition);
}

}  // namespace
}  // namespace spelunk::navigation
