#include "spelunk/navigation/point_to_point.h"

#include <gtest/gtest.h>

#include <limits>

#include "spelunk/common/contract.h"
#include "spelunk/navigation/swept_path_check.h"
#include "support/grid_world.h"

namespace spelunk::navigation {
namespace {

/// Two halls joined by a door at the far end.
std::shared_ptr<const map::FrozenMap> twoHalls() {
  test::GridWorld world({40, 30, 8}, 0.5);
  world.carve({{0.5, 0.5, 0.5}, {19.5, 6.5, 3.5}});
  world.carve({{0.5, 7.5, 0.5}, {19.5, 14.5, 3.5}});
  world.carve({{16.0, 6.0, 0.5}, {18.5, 8.0, 3.5}});
  map::MapParams params;
  params.resolution_m = 0.25;
  params.range_min_m = 0.0;
  map::OccupancyMap map(params);
  world.enterInto(map);
  return map.freeze();
}

PointToPointRequest request() {
  static const auto kMap = twoHalls();
  PointToPointRequest request;
  request.map = kMap;
  request.start = {{2.0, 3.0, 2.0}, 0.0};
  request.goal = {{2.0, 11.0, 2.0}, 1.0};
  request.box = {0.8, 0.8, 0.4};
  request.rng = Rng(11);
  return request;
}

TEST(PointToPoint, FindsTheDoor) {
  const PointToPointRequest asked = request();
  const PointToPointResult result = planPointToPoint(asked);
  ASSERT_EQ(result.status, PointToPointStatus::kOk) << result.reason;
  EXPECT_EQ(result.path.front().position, asked.start.position);
  EXPECT_EQ(result.path.back().position, asked.goal.position);
  EXPECT_EQ(result.path.back().yaw, 1.0);
  map::ConfigurationSpace space(asked.box, asked.map);
  EXPECT_TRUE(checkPath(space, result.path, {}, {}).isFree());
  EXPECT_LT(lengthOf(result.path), 45.0);
}

TEST(PointToPoint, SameRequestGivesTheSamePath) {
  const PointToPointResult first = planPointToPoint(request());
  for (int k = 0; k < 3; ++k) {
    const PointToPointResult again = planPointToPoint(request());
    ASSERT_EQ(again.path.size(), first.path.size());
    for (std::size_t i = 0; i < first.path.size(); ++i)
      EXPECT_EQ(again.path[i].position, first.path[i].position);
  }
}

TEST(PointToPoint, StraightLineNeedsNoSamples) {
  PointToPointRequest asked = request();
  asked.goal = {{8.0, 3.0, 2.0}, 0.0};
  const PointToPointResult result = planPointToPoint(asked);
  EXPECT_EQ(result.path.size(), 2U);
  EXPECT_EQ(result.samples, 0);
}

TEST(PointToPoint, EachRefusalHasItsStatusAndReason) {
  PointToPointRequest asked = request();
  asked.goal.position.y() = 100.0;
  EXPECT_EQ(planPointToPoint(asked).status, PointToPointStatus::kGoalBlocked);
  asked = request();
  asked.start.position.z() = -5.0;
  EXPECT_EQ(planPointToPoint(asked).status, PointToPointStatus::kStartBlocked);
  asked = request();
  asked.bounds.max.y() = 8.0;
  EXPECT_EQ(planPointToPoint(asked).status, PointToPointStatus::kOutOfBounds);
  asked = request();
  NoGoZone door;
  door.name = "door";
  door.polygon = {{15.0, 6.0}, {19.5, 6.0}, {19.5, 8.0}, {15.0, 8.0}};
  asked.zones = {door};
  asked.iterations = 500;
  const PointToPointResult shut = planPointToPoint(asked);
  EXPECT_EQ(shut.status, PointToPointStatus::kNoPath);
  EXPECT_TRUE(shut.path.empty());
  EXPECT_FALSE(shut.reason.empty());
}

TEST(PointToPoint, BadRequestsBreakTheContract) {
  PointToPointRequest asked = request();
  asked.map.reset();
  EXPECT_THROW(static_cast<void>(planPointToPoint(asked)), Precondition);
  asked = request();
  asked.goal.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(planPointToPoint(asked)), Precondition);
}

}  // namespace
}  // namespace spelunk::navigation
