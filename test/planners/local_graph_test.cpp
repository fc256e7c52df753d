#include "spelunk/planners/gbplanner/local_graph.h"

#include <gtest/gtest.h>

#include "spelunk/map/configuration_space.h"
#include "support/grid_world.h"

namespace spelunk::planners::gbplanner {
namespace {

const Eigen::Vector3d kBox(1.0, 1.0, 0.4);
const Eigen::Vector3d kRoot(3.0, 2.5, 2.5);

class AKnownCorridor : public ::testing::Test {
 protected:
  AKnownCorridor() {
    map::MapParams map_params;
    map_params.resolution_m = 0.25;
    map_params.range_min_m = 0.0;
    map::OccupancyMap map(map_params);
    test::corridorWorld(24.0).enterInto(map);
    frozen_ = map.freeze();
    inflated_ = std::make_unique<map::ConfigurationSpace>(kBox, frozen_);
  }
  [[nodiscard]] FreeSpace space() const {
    return {[this](const auto& a, const auto& b) { return inflated_->sweep(a, b); }, kBox, bounds_,
            zones_};
  }
  [[nodiscard]] LocalGraph build(std::uint64_t seed, const PlanBudget& budget, PlanStats& stats) {
    const map::FreeVoxels sampler(frozen_, {{0.0, 0.0, 0.0}, {24.0, 5.0, 5.0}});
    return buildLocalGraph(kRoot, sampler, space(), space(), params_, budget, Rng(seed), stats);
  }

  AxisAlignedBox bounds_;
  std::vector<NoGoZone> zones_;
  GbPlannerParams params_;
  std::shared_ptr<const map::FrozenMap> frozen_;
  std::unique_ptr<map::ConfigurationSpace> inflated_;
};

TEST_F(AKnownCorridor, GrowsAConnectedGraphOfFreeEdges) {
  PlanStats stats;
  const LocalGraph local = build(1, {4000, 1e9}, stats);
  EXPECT_GT(local.graph.vertexCount(), 20U);
  EXPECT_EQ(stats.vertices, static_cast<int>(local.graph.vertexCount()));
  const graph::ShortestPaths paths = graph::shortestPaths(local.graph, local.root);
  for (std::size_t i = 0; i < local.graph.vertexCount(); ++i)
    EXPECT_TRUE(paths.reaches(graph::VertexId{static_cast<std::uint32_t>(i)}));
  for (const auto& [a, b] : local.graph.edges())
    EXPECT_TRUE(space().isFree(local.graph.position(a), local.graph.position(b)));
}

TEST_F(AKnownCorridor, StopsAtItsLimits) {
  params_.max_vertices = 12;
  PlanStats stats;
  EXPECT_EQ(build(1, {4000, 1e9}, stats).graph.vertexCount(), 12U);
  params_.max_vertices = 500;
  PlanStats few;
  static_cast<void>(build(1, {50, 1e9}, few));
  EXPECT_EQ(few.samples, 50);
}

TEST_F(AKnownCorridor, RepeatsWithItsSeed) {
  PlanStats stats;
  const LocalGraph one = build(9, {1000, 1e9}, stats);
  const LocalGraph same = build(9, {1000, 1e9}, stats);
  const LocalGraph other = build(10, {1000, 1e9}, stats);
  ASSERT_EQ(one.graph.vertexCount(), same.graph.vertexCount());
  EXPECT_EQ(one.graph.edges(), same.graph.edges());
  const graph::VertexId last{static_cast<std::uint32_t>(one.graph.vertexCount() - 1)};
  EXPECT_EQ(one.graph.position(last), same.graph.position(last));
  EXPECT_NE(one.graph.edges(), other.graph.edges());
}

TEST_F(AKnownCorridor, CountsWhySamplesWereRejected) {
  zones_.push_back({"pit", {{10.0, 0.0}, {12.0, 0.0}, {12.0, 5.0}, {10.0, 5.0}}});
  bounds_.max.x() = 20.0;
  PlanStats stats;
  const LocalGraph local = build(1, {6000, 1e9}, stats);
  EXPECT_GT(stats.rejected_occupied, 0);
  EXPECT_GT(stats.rejected_no_go, 0);
  for (std::size_t i = 0; i < local.graph.vertexCount(); ++i) {
    EXPECT_LT(local.graph.position(graph::VertexId{static_cast<std::uint32_t>(i)}).x(), 10.0)
        << "the zone fills the corridor";
  }
}

TEST_F(AKnownCorridor, SamplesOnlyKnownFreeSpaceOfTheBox) {
  const AxisAlignedBox box{{5.0, 0.0, 0.0}, {9.0, 5.0, 5.0}};
  const map::FreeVoxels sampler(frozen_, box);
  Rng rng(4);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point = *sampler.draw(rng);
    EXPECT_EQ(frozen_->at(point), map::Occupancy::kFree);
    EXPECT_TRUE(box.contains(point));
  }
  EXPECT_FALSE(map::FreeVoxels(frozen_, {{0.0, 0.0, 0.0}, {0.9, 5.0, 5.0}}).draw(rng).has_value());
}

}  // namespace
}  // namespace spelunk::planners::gbplanner
