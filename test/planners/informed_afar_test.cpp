// Informed Exploration and a sensor that sees farther than its rows are dense: frontier at the far
// end of a gallery of which only a layer one voxel high is known, and places it has looked from.
#include <gtest/gtest.h>

#include "spelunk/planners/factory.h"
#include "spelunk/planners/informed/informed_params.h"
#include "support/grid_world.h"

namespace spelunk::planners {
namespace {

constexpr double kResolution = 0.25;
constexpr double kKnownEnd = 12.0;  // along x
constexpr double kSeenEnd = 40.0;

class GallerySeenFromAfar : public ::testing::Test {
 protected:
  GallerySeenFromAfar() {
    robot_.box_m = {0.8, 0.8, 0.4};
    SensorModel sensor;
    sensor.columns = 360;
    sensor.fov_vertical_deg = 60.0;
    robot_.sensor_models = {sensor};
    map::MapParams params;
    params.resolution_m = kResolution;
    params.range_min_m = 0.0;
    map_ = std::make_unique<map::OccupancyMap>(params);
    test::GridWorld world({124, 10, 9}, 0.5);
    world.carve({{1.0, 1.0, 1.0}, {60.0, 4.0, 3.5}});
    world.enterRock(*map_);
    know({{1.0, 1.0, 1.0}, {kKnownEnd, 4.0, 3.5}});
    request_.home = {{6.0, 2.5, 2.25}, 0.0};
    request_.rng = Rng(5);
  }
  void know(const AxisAlignedBox& box) {
    map_->markFree({box.min.array() + 1e-6, box.max.array() - 1e-6});
  }
  /// A row of the LiDAR; the gaps above and below it are too low to hold anything.
  void knowLayer() { know({{kKnownEnd, 1.0, 2.25}, {kSeenEnd, 4.0, 2.5}}); }

  PlanResult planFrom(double x, const std::vector<double>& flown_x = {}) {
    ParamTree tree;
    tree.setAssignment("informed.visited_radius_m=2", "the test");  // from wall to wall
    const auto planner = makePlanner("informed", tree, robot_, kResolution);
    request_.map = map_->freeze();
    request_.pose = {{x, 2.5, 2.25}, 0.0};
    request_.time_s = static_cast<double>(flown_x.size());
    request_.trail.clear();
    for (std::size_t i = 0; i < flown_x.size(); ++i)
      request_.trail.push_back({static_cast<double>(i), {{flown_x[i], 2.5, 2.25}, 0.0}});
    return planner->plan(request_);
  }

  RobotModel robot_;
  std::unique_ptr<map::OccupancyMap> map_;
  PlanRequest request_;
};

TEST_F(GallerySeenFromAfar, IsFlownTowardsAsFarAsItIsKnown) {
  knowLayer();
  const PlanResult result = planFrom(6.0);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  EXPECT_EQ(result.kind, PathKind::kReposition);
  EXPECT_NE(result.reason.find("seen from afar"), std::string::npos) << result.reason;
  EXPECT_GT(result.path.back().position.x(), 9.0);
  EXPECT_LT(result.path.back().position.x(), kKnownEnd) << "into space never seen";
}

TEST_F(GallerySeenFromAfar, IsGivenUpWhereNoPieceOfTheWayCanBeFlown) {
  knowLayer();
  const PlanResult result = planFrom(11.3);  // 0.3 m are left to go
  EXPECT_EQ(result.status, PlanStatus::kNothingToGain) << result.reason;
}

TEST_F(GallerySeenFromAfar, FrontierIsNotLookedAtAgainFromWhereTheRobotHasBeen) {
  const PlanResult never = planFrom(6.0);
  ASSERT_EQ(never.status, PlanStatus::kOk) << never.reason;
  EXPECT_GT(never.path.back().position.x(), 9.0);
  const PlanResult been = planFrom(6.0, {6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 11.4, 10.0, 8.0, 6.0});
  EXPECT_EQ(been.status, PlanStatus::kNothingToGain) << been.reason;
}

TEST(InformedParams, PlacesSeenFromCountOnlyForSensorsThatLookAllRound) {
  RobotModel robot;
  SensorModel sensor;
  robot.sensor_models = {sensor};
  informed::InformedParams params;
  EXPECT_DOUBLE_EQ(params.resolvedFor(robot).visited_radius_m, 1.0);
  params.visited_radius_m = 0.7;
  EXPECT_DOUBLE_EQ(params.resolvedFor(robot).visited_radius_m, 0.7);
  params = {};
  params.range_m = 4.0;
  EXPECT_DOUBLE_EQ(params.resolvedFor(robot).visited_radius_m, 0.0);
  params = {};
  robot.sensor_models.front().fov_horizontal_deg = 90.0;
  EXPECT_DOUBLE_EQ(params.resolvedFor(robot).visited_radius_m, 0.0);
}

}  // namespace
}  // namespace spelunk::planners
