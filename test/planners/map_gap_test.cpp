// A gallery seen from both ends, its middle only in a layer one voxel high: no way for a box, but
// presumably one.
#include <gtest/gtest.h>

#include "spelunk/graph/path_similarity.h"
#include "spelunk/planners/factory.h"
#include "support/grid_world.h"

namespace spelunk::planners {
namespace {

constexpr double kResolution = 0.25;
constexpr double kGapBegin = 12.0;  // along x
constexpr double kGapEnd = 16.0;
const Eigen::Vector3d kFrontier(30.0, 2.5, 2.5);

/// Four galleries around rock and a room behind the frontier.
test::GridWorld ringWithARoom() {
  test::GridWorld world({96, 48, 10}, 0.5);
  world.carve({{1.0, 1.0, 1.0}, {31.0, 4.0, 4.0}});
  world.carve({{1.0, 1.0, 1.0}, {4.0, 22.0, 4.0}});
  world.carve({{1.0, 19.0, 1.0}, {31.0, 22.0, 4.0}});
  world.carve({{28.0, 1.0, 1.0}, {31.0, 22.0, 4.0}});
  world.carve({{31.0, 1.0, 1.0}, {46.0, 22.0, 4.0}});
  return world;
}

/// Home at one side of the gap, then the vertices of the long way round to the frontier.
PlannerGraph longWayRound() {
  PlannerGraph saved;
  GraphLayer& layer = saved.layers.emplace_back();
  layer.name = "global";
  const std::vector<Eigen::Vector3d> corners{
      {6.0, 2.5, 2.5}, {2.5, 2.5, 2.5}, {2.5, 20.5, 2.5}, {29.5, 20.5, 2.5}, {29.5, 2.5, 2.5}};
  for (std::size_t i = 1; i < corners.size(); ++i)
    for (const Eigen::Vector3d& at : graph::resampled({corners[i - 1], corners[i]}, 2.0))
      layer.vertices.push_back({at, 0.0, false});
  layer.vertices.push_back({kFrontier, 500.0, true});
  for (std::uint32_t i = 1; i < layer.vertices.size(); ++i) layer.edges.emplace_back(i - 1, i);
  return saved;
}

class GapOfTheMap : public ::testing::Test {
 protected:
  GapOfTheMap() {
    robot_.box_m = {0.8, 0.8, 0.4};
    SensorModel sensor;
    sensor.columns = 360;
    sensor.fov_vertical_deg = 60.0;
    sensor.gain_range_m = 10.0;
    robot_.sensor_models = {sensor};
    map::MapParams params;
    params.resolution_m = kResolution;
    params.range_min_m = 0.0;
    map_ = std::make_unique<map::OccupancyMap>(params);
    ringWithARoom().enterRock(*map_);
    for (const AxisAlignedBox& known :
         {AxisAlignedBox{{1.0, 1.0, 1.0}, {kGapBegin, 4.0, 4.0}},
          AxisAlignedBox{{kGapEnd, 1.0, 1.0}, {33.0, 4.0, 4.0}},
          AxisAlignedBox{{1.0, 4.0, 1.0}, {4.0, 22.0, 4.0}},
          AxisAlignedBox{{4.0, 19.0, 1.0}, {31.0, 22.0, 4.0}},
          AxisAlignedBox{{28.0, 4.0, 1.0}, {31.0, 19.0, 4.0}},
          AxisAlignedBox{{kGapBegin, 1.0, 2.25}, {kGapEnd, 4.0, 2.5}}})
      map_->markFree({known.min.array() + 1e-6, known.max.array() - 1e-6});
    request_.home = {{6.0, 2.5, 2.5}, 0.0};
    request_.map = map_->freeze();
    request_.rng = Rng(5);
  }
  /// Local paths are never worth it; the room behind the frontier is, what the gap hides is not.
  PlanResult planFrom(double x, double presumed_saving_m) {
    ParamTree tree;
    for (const std::string& assignment :
         {std::string("count_cones=true"), std::string("gain_threshold_m3=100000"),
          std::string("frontier_gain_m3=100"),
          "presumed_saving_m=" + std::to_string(presumed_saving_m)})
      tree.setAssignment("gbplanner." + assignment, "the test");
    const auto planner = makePlanner("gbplanner", tree, robot_, kResolution);
    planner->restore(longWayRound());
    request_.pose = {{x, 2.5, 2.5}, 0.0};
    return planner->plan(request_);
  }

  RobotModel robot_;
  std::unique_ptr<map::OccupancyMap> map_;
  PlanRequest request_;
};

TEST_F(GapOfTheMap, IsFlownTowardsIfThatSavesALongWay) {
  const PlanResult result = planFrom(6.0, 30.0);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  EXPECT_EQ(result.kind, PathKind::kReposition);
  EXPECT_NE(result.reason.find("through a gap of the map"), std::string::npos) << result.reason;
  EXPECT_GT(result.path.back().position.x(), 9.0);
  EXPECT_LT(result.path.back().position.x(), kGapBegin) << "into space never seen";
}

TEST_F(GapOfTheMap, IsLeftAloneIfThatSavesTooLittle) {
  const PlanResult result = planFrom(6.0, 100.0);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  EXPECT_GT(lengthOf(result.path), 60.0) << result.reason;
}

TEST_F(GapOfTheMap, IsGivenUpAtItsMouthAndTheKnownWayTaken) {
  const PlanResult result = planFrom(11.3, 30.0);  // 0.3 m are left to go
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.reason;
  EXPECT_GT(lengthOf(result.path), 60.0) << result.reason;
  EXPECT_NEAR((result.path.back().position - kFrontier).norm(), 0.0, 1.0);
}

}  // namespace
}  // namespace spelunk::planners
