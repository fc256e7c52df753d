#include "spelunk/planners/shared/frontier_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/planners/shared/flight_line.h"
#include "spelunk/planners/shared/free_place.h"
#include "spelunk/planners/shared/known_space.h"
#include "support/frontier_world.h"

namespace spelunk::planners {
namespace {

constexpr double kResolution = test::FrontierWorld::kResolution_m;

test::FrontierWorld seenCorridor() {
  test::FrontierWorld world(test::corridorWorld(40.0));
  world.lookFrom({4.0, 2.5, 2.5});
  return world;
}

TEST(FrontierView, SeesTheUnknownBehindTheFrontierAndNotBehindWalls) {
  const test::FrontierWorld world = seenCorridor();
  FrontierView view(world.robot, kResolution, {4.0, {0.0, 0.0}});
  view.look(world.request.map);
  EXPECT_GT(view.frontier().count(), 100U);
  const double known_end = view.seenFrom({3.0, 2.5, 2.5}, 0.0, {}).unknown_m3;
  const double frontier = view.seenFrom({9.0, 2.5, 2.5}, 0.0, {}).unknown_m3;
  EXPECT_LT(known_end, 0.3 * frontier);
  EXPECT_GT(frontier, 10.0);
  EXPECT_LT(frontier, 4.0 / 3.0 * M_PI * 64.0) << "no more than the sphere of the range holds";
}

TEST(FrontierView, DoesNotLookBeyondTheBounds) {
  const test::FrontierWorld world = seenCorridor();
  FrontierView view(world.robot, kResolution, {4.0, {0.0, 0.0}});
  view.look(world.request.map);
  AxisAlignedBox bounds;
  bounds.max.x() = 9.5;
  const Eigen::Vector3d place(9.0, 2.5, 2.5);
  EXPECT_LT(view.seenFrom(place, 0.0, bounds).unknown_voxels,
            view.seenFrom(place, 0.0, {}).unknown_voxels / 2);
}

TEST(FrontierView, MeasuresTheClearanceOfAPlace) {
  const test::FrontierWorld world = seenCorridor();
  const map::FrozenMap& map = *world.request.map;
  Rng rng(4);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d place(rng.uniform(2.0, 8.0), rng.uniform(1.2, 3.8), 2.5);
    double nearest = 2.0;
    map.forEachOccupied({}, [&](const map::VoxelIndex& voxel) {
      nearest = std::min(nearest, (map.centreOf(voxel) - place).norm());
    });
    EXPECT_NEAR(FrontierView::clearanceAt(map, place, 2.0), nearest, 1e-9);
  }
}

TEST(PlaceFinder, FindsTheNearestFreePlaceOnItsGrid) {
  const test::FrontierWorld world = seenCorridor();
  navigation::Navigator navigator({});
  map::ConfigurationSpace boxes(world.robot.box_m);
  const KnownSpace space(world.request, world.robot, navigator, boxes);
  const PlaceFinder places(1.5, 0.25);
  const Eigen::Vector3d inside(4.0, 2.5, 2.5);
  EXPECT_EQ(*places.find(inside, space.free()), inside);
  const Eigen::Vector3d in_wall(4.0, 0.9, 2.5);
  const auto beside = places.find(in_wall, space.free());
  ASSERT_TRUE(beside.has_value());
  EXPECT_EQ(space.free().at(*beside), Rejection::kNone);
  for (double y = in_wall.y(); y < beside->y() - 0.2; y += 0.25)
    EXPECT_NE(space.free().at({4.0, y, 2.5}), Rejection::kNone);
  EXPECT_FALSE(places.find({4.0, -3.0, 2.5}, space.free()).has_value());
}

TEST(KnownSpace, LeavesOutWaypointsOnlyWhereAFreeWayLeadsPastThem) {
  const test::FrontierWorld world = seenCorridor();
  navigation::Navigator navigator({});
  map::ConfigurationSpace boxes(world.robot.box_m);
  const KnownSpace space(world.request, world.robot, navigator, boxes);
  const graph::Polyline zigzag{{2.5, 2.0, 2.5}, {3.5, 3.0, 2.5}, {4.5, 2.0, 2.5}, {5.5, 3.0, 2.5}};
  ASSERT_TRUE(space.isFree(zigzag));
  EXPECT_EQ(space.shortened(zigzag, 20.0), (graph::Polyline{zigzag.front(), zigzag.back()}));
  EXPECT_EQ(space.shortened(zigzag, 1.0), zigzag) << "no longer than the reach";
  EXPECT_FALSE(space.isFree({{4.0, 2.5, 2.5}, {4.0, -2.0, 2.5}}));
}

TEST(FlightLine, LooksWhereItGoes) {
  const Path path = toPath({{0, 0, 0}, {0, 2, 0}, {0, 2, 3}, {-1, 2, 3}}, {{0, 0, 0}, 0.7});
  ASSERT_EQ(path.size(), 4U);
  EXPECT_DOUBLE_EQ(path[0].yaw, 0.7);
  EXPECT_DOUBLE_EQ(path[1].yaw, 0.5 * M_PI);
  EXPECT_DOUBLE_EQ(path[2].yaw, 0.5 * M_PI) << "a vertical step keeps the heading";
  EXPECT_DOUBLE_EQ(path[3].yaw, M_PI);
  EXPECT_EQ(toLine(path).back(), Eigen::Vector3d(-1, 2, 3));
}

}  // namespace
}  // namespace spelunk::planners
