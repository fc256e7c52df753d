#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/planners/informed/region_reasoner.h"
#include "spelunk/planners/informed/utility.h"
#include "support/frontier_world.h"

namespace spelunk::planners::informed {
namespace {

TEST(Entropy, IsOneBitForEachUnknownVoxelSeen) {
  map::VolumetricGain seen;
  seen.unknown_voxels = 120;
  seen.free_voxels = 1000;
  seen.occupied_voxels = 50;
  EXPECT_DOUBLE_EQ(entropyOf(seen, {}), 120.0);
}

TEST(Entropy, OfKnownVoxelsIsThatOfTheMapsLimitsWhenAskedFor) {
  const auto bits = [](double p) { return -p * std::log2(p) - (1.0 - p) * std::log2(1.0 - p); };
  InformedParams params;
  params.entropy_free_bits = bits(0.12);
  params.entropy_occupied_bits = bits(0.97);
  EXPECT_NEAR(params.entropy_free_bits, 0.53, 0.005);
  EXPECT_NEAR(params.entropy_occupied_bits, 0.19, 0.005);
  map::VolumetricGain seen;
  seen.unknown_voxels = 10;
  seen.free_voxels = 100;
  seen.occupied_voxels = 20;
  EXPECT_NEAR(entropyOf(seen, params), 10.0 + 100.0 * bits(0.12) + 20.0 * bits(0.97), 1e-9);
}

TEST(Utility, IsTheProductOfThePaper) {
  const InformedParams params;  // alpha 1, beta 0.2, delta 1, gamma 0.5, zeta 0.2 or 0.6
  const UtilityTerms terms{300.0, 500.0, 6.0, 1.5, Region::kVoid};
  EXPECT_NEAR(std::exp(logUtility(terms, params)),
              (300.0 + 0.2 * 500.0) * std::exp(-0.5 * 6.0) * (1.0 + 0.2 * 1.5), 1e-9);
  UtilityTerms narrow = terms;
  narrow.region = Region::kBranch;
  EXPECT_NEAR(std::exp(logUtility(narrow, params) - logUtility(terms, params)),
              (1.0 + 0.6 * 1.5) / (1.0 + 0.2 * 1.5), 1e-12);
}

TEST(Utility, RanksWaysThatAreVeryLong) {
  UtilityTerms near{100.0, 0.0, 4000.0, 0.0, Region::kVoid};
  UtilityTerms far = near;
  far.length_m = 4001.0;
  EXPECT_GT(logUtility(near, {}), logUtility(far, {}));
  EXPECT_EQ(std::exp(logUtility(near, {})), 0.0) << "the product itself has vanished";
  near.entropy_end_bits = 0.0;
  EXPECT_LT(logUtility(near, {}), logUtility(far, {})) << "nothing to gain is worst";
}

TEST(Utility, CountsEntropyAtEveryRangeOfTheWayButItsEnd) {
  test::FrontierWorld world(test::corridorWorld(40.0));
  world.lookFrom({4.0, 2.5, 2.5});
  FrontierView view(world.robot, test::FrontierWorld::kResolution_m, {4.0, {0.0, 0.0}});
  view.look(world.request.map);
  const InformedParams params = test::seeingFourMetres();
  const auto bitsAt = [&](double x) {
    return entropyOf(view.seenFrom({x, 2.5, 2.5}, 0.0, {}), params);
  };
  const graph::Polyline way{{4.0, 2.5, 2.5}, {9.0, 2.5, 2.5}, {13.5, 2.5, 2.5}};
  EXPECT_GT(bitsAt(12.0), 0.0);
  EXPECT_DOUBLE_EQ(entropyAlong(way, view, {}, params), bitsAt(4.0) + bitsAt(8.0) + bitsAt(12.0));
}

TEST(RegionReasoner, CallsACorridorABranchAndAHallAVoid) {
  test::FrontierWorld corridor(test::corridorWorld(40.0));
  corridor.lookFrom({8.0, 2.5, 2.5});
  const Pose along{{8.0, 2.5, 2.5}, 0.0};
  const Pose across{{8.0, 2.5, 2.5}, 0.5 * M_PI};
  EXPECT_EQ(regionAt(*corridor.request.map, along, 3.0), Region::kBranch);
  EXPECT_EQ(regionAt(*corridor.request.map, across, 3.0), Region::kBranch) << "by the x axis";
  EXPECT_EQ(regionAt(*corridor.request.map, along, 1.0), Region::kVoid) << "walls are too far";
  test::GridWorld hall({60, 60, 10}, 0.5);
  hall.carve({{1.0, 1.0, 1.0}, {29.0, 29.0, 4.0}});
  test::FrontierWorld wide(std::move(hall));
  wide.lookFrom({15.0, 15.0, 2.5});
  EXPECT_EQ(regionAt(*wide.request.map, {{15.0, 15.0, 2.5}, 0.3}, 3.0), Region::kVoid);
}

TEST(RegionReasoner, DoesNotTakeUnknownSpaceForWalls) {
  map::MapParams params;
  params.resolution_m = 0.25;
  map::OccupancyMap map(params);
  map.markFree(boxAround({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
  EXPECT_EQ(regionAt(*map.freeze(), {}, 5.0), Region::kVoid);
}

/// Two rays 0.4 m apart where the box is 0.4 m high: all there is known, and no farther.
TEST(InformedRange, IsWhereTheRowsAreAsFarApartAsTheBoxIsHigh) {
  RobotModel robot;
  robot.box_m = {1.0, 1.0, 0.4};
  SensorModel sensor;
  sensor.rows = 16;
  sensor.fov_vertical_deg = 30.0;
  sensor.gain_range_m = 50.0;
  robot.sensor_models = {sensor};
  const InformedParams given;
  const InformedParams resolved = given.resolvedFor(robot);
  EXPECT_NEAR(resolved.range_m * std::tan(2.0 * M_PI / 180.0), 0.4, 1e-9);
  EXPECT_NEAR(resolved.length_decay * resolved.range_m, given.length_decay * 4.0, 1e-9);
  EXPECT_NEAR(resolved.sample_spacing_m / resolved.range_m, given.sample_spacing_m / 4.0, 1e-9);
  robot.sensor_models.front().gain_range_m = 4.0;
  EXPECT_DOUBLE_EQ(given.resolvedFor(robot).range_m, 4.0) << "no farther than it sees";
  EXPECT_DOUBLE_EQ(given.resolvedFor(robot).gain_min_m3, given.gain_min_m3);
  EXPECT_DOUBLE_EQ(test::seeingFourMetres().resolvedFor(robot).range_m, 4.0);
}

}  // namespace
}  // namespace spelunk::planners::informed
