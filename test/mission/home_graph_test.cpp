#include "spelunk/mission/home_graph.h"

#include <gtest/gtest.h>

#include "support/grid_world.h"

namespace spelunk::mission {
namespace {

const Eigen::Vector3d kBox(0.8, 0.8, 0.4);
constexpr double kResolution_m = 0.25;

map::OccupancyMap mapOf(const test::GridWorld& world) {
  map::MapParams params;
  params.resolution_m = kResolution_m;
  params.range_min_m = 0.0;
  map::OccupancyMap map(params);
  world.enterInto(map);
  return map;
}

/// Out along y = 2.5 and back along y = 4.5 of an open hall.
test::GridWorld hall() {
  test::GridWorld world({60, 16, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {29.0, 7.0, 4.0}});
  return world;
}

HomeGraph outAndBack() {
  HomeGraph graph({{3.0, 2.5, 2.5}, 0.0}, kBox, kResolution_m);
  for (double x = 3.0; x <= 25.0; x += 0.25) graph.addTrail({{x, 2.5, 2.5}, 0.0});
  for (double x = 25.0; x >= 5.0; x -= 0.25) graph.addTrail({{x, 4.5, 2.5}, 0.0});
  return graph;
}

TEST(HomeGraph, TrailAloneLeadsBackTheWayFlown) {
  HomeGraph graph = outAndBack();
  const auto way = graph.wayFrom({{5.0, 4.5, 2.5}, 0.0});
  ASSERT_TRUE(way);
  EXPECT_NEAR(lengthOf(*way), 44.0, 1.5);
  EXPECT_EQ(way->back().position, graph.home().position);
}

TEST(HomeGraph, ShortcutAcrossFreeSpaceSavesTheDetour) {
  HomeGraph graph = outAndBack();
  auto map = mapOf(hall());
  graph.connect(map.freeze());
  const auto way = graph.wayFrom({{5.0, 4.5, 2.5}, 0.0});
  ASSERT_TRUE(way);
  EXPECT_LT(lengthOf(*way), 5.0);
}

TEST(HomeGraph, WallBetweenLegsForbidsTheShortcut) {
  test::GridWorld world = hall();
  world.block({{1.0, 3.0, 1.0}, {23.0, 4.0, 4.0}});
  auto map = mapOf(world);
  HomeGraph graph = outAndBack();
  graph.connect(map.freeze());
  const auto way = graph.wayFrom({{5.0, 4.5, 2.5}, 0.0});
  ASSERT_TRUE(way);
  EXPECT_GT(lengthOf(*way), 35.0);
}

TEST(HomeGraph, NewObstacleCutsShortcutsAndTrail) {
  auto map = mapOf(hall());
  HomeGraph graph = outAndBack();
  graph.connect(map.freeze());
  // A wall across the whole hall between home and the robot.
  std::vector<map::VoxelIndex> wall;
  for (int y = 4; y < 28; ++y)
    for (int z = 4; z < 16; ++z) wall.emplace_back(16, y, z);
  graph.noteOccupied(wall);
  EXPECT_FALSE(graph.wayFrom({{10.0, 4.5, 2.5}, 0.0}));
  graph.recheckAll(map.freeze());  // the map itself has no wall: the cut was momentary
  EXPECT_TRUE(graph.wayFrom({{10.0, 4.5, 2.5}, 0.0}));
}

TEST(HomeGraph, CutTrailTellsWhereAndWhatStillLeadsHome) {
  HomeGraph graph = outAndBack();
  const Pose robot{{20.0, 2.5, 2.5}, 0.0};
  EXPECT_FALSE(graph.findCut(robot));
  std::vector<map::VoxelIndex> wall;  // x 12 .. 12.25 across the first leg
  for (int y = 4; y < 14; ++y)
    for (int z = 4; z < 16; ++z) wall.emplace_back(48, y, z);
  graph.noteOccupied(wall);
  const auto cut = graph.findCut(robot);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->x(), 12.1, 1.0);
  EXPECT_EQ(cut->y(), 2.5);
  const std::vector<Pose> places = graph.placesBeforeHome(robot);
  ASSERT_GE(places.size(), 4U);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_LT(places[i].position.x(), 12.0);
    EXPECT_TRUE(graph.wayFrom(places[i]));
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GE(distance(places[i], robot), distance(places[k], robot));
      EXPECT_GE(distance(places[i], places[k]), 2.0);
    }
  }
  EXPECT_GT(places.front().position.x(), 10.0);
}

TEST(HomeGraph, FlownEdgeWithoutMarginStaysAsLastResort) {
  HomeGraph graph({{3.0, 2.4, 2.5}, 0.0}, kBox, kResolution_m);
  for (double x = 3.0; x <= 20.0; x += 0.25) graph.addTrail({{x, 2.4, 2.5}, 0.0});
  // Begins at y = 2.75: within the box (0.4 m half width), outside the tighter one (0.3 m).
  graph.noteOccupied({map::VoxelIndex(40, 11, 10)});
  const auto way = graph.wayFrom({{20.0, 2.4, 2.5}, 0.0});
  ASSERT_TRUE(way);
  EXPECT_NEAR(lengthOf(*way), 17.0, 1.0);
}

TEST(HomeGraph, CheckedRouteOfThePlannerIsUsedWhenShorter) {
  HomeGraph graph = outAndBack();
  graph.addRoute({{{15.0, 4.5, 2.5}, 0.0}, {{3.0, 4.5, 2.5}, 0.0}, {{3.0, 2.5, 2.5}, 0.0}});
  const auto way = graph.wayFrom({{15.0, 4.5, 2.5}, 0.0});
  ASSERT_TRUE(way);
  EXPECT_NEAR(lengthOf(*way), 14.0, 1.0);
}

TEST(HomeGraph, ZoneCutsShortcutsForGoodButNotTheTrail) {
  const test::GridWorld world = hall();
  const auto map = mapOf(world).freeze();
  HomeGraph graph = outAndBack();
  graph.connect(map);
  const Pose end{{5.0, 4.5, 2.5}, 0.0};
  ASSERT_LT(lengthOf(*graph.wayFrom(end)), 10.0);  // across
  NoGoZone zone;
  zone.polygon = {{2.0, 3.2}, {28.0, 3.2}, {28.0, 3.8}, {2.0, 3.8}};
  graph.noteZone(zone);
  for (int k = 0; k < 10; ++k) graph.connect(map);
  graph.recheckAll(map);
  EXPECT_NEAR(lengthOf(*graph.wayFrom(end)), 44.0, 1.5);  // the way it came
}

TEST(HomeGraph, ZoneForbidsLaterShortcutsAndRoutes) {
  const auto map = mapOf(hall()).freeze();
  HomeGraph graph = outAndBack();
  NoGoZone zone;
  zone.polygon = {{2.0, 3.2}, {28.0, 3.2}, {28.0, 3.8}, {2.0, 3.8}};
  graph.noteZone(zone);
  graph.connect(map);
  graph.addRoute({{{5.0, 4.5, 2.5}, 0.0}, {{5.0, 2.5, 2.5}, 0.0}});
  EXPECT_NEAR(lengthOf(*graph.wayFrom({{5.0, 4.5, 2.5}, 0.0})), 44.0, 1.5);  // the way it came
}

TEST(HomeGraph, TakesNoShortcutWithoutFooting) {
  const test::GridWorld world = hall();
  const auto map = mapOf(world).freeze();
  int asked = 0;
  HomeGraph graph({{3.0, 2.5, 2.5}, 0.0}, kBox, kResolution_m,
                  [&](const map::FrozenMap&, const Eigen::Vector3d&, const Eigen::Vector3d&) {
                    ++asked;
                    return false;
                  });
  for (double x = 3.0; x <= 25.0; x += 0.25) graph.addTrail({{x, 2.5, 2.5}, 0.0});
  for (double x = 25.0; x >= 5.0; x -= 0.25) graph.addTrail({{x, 4.5, 2.5}, 0.0});
  graph.connect(map);
  EXPECT_GT(asked, 10);
  EXPECT_NEAR(lengthOf(*graph.wayFrom({{5.0, 4.5, 2.5}, 0.0})), 44.0, 1.5);
}

}  // namespace
}  // namespace spelunk::mission
