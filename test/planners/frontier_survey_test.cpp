#include "spelunk/planners/informed/frontier_survey.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "spelunk/planners/informed/frontier_sampler.h"
#include "spelunk/planners/shared/known_space.h"
#include "support/frontier_world.h"

namespace spelunk::planners::informed {
namespace {

using graph::VertexId;

/// A corridor seen from its beginning, and a graph with one vertex there.
class SeenCorridor : public ::testing::Test {
 protected:
  SeenCorridor()
      : params_(test::seeingFourMetres()),
        world_(test::corridorWorld(40.0)),
        view_(world_.robot, test::FrontierWorld::kResolution_m, {4.0, {0.0, 0.0}}),
        survey_(view_, world_.request, params_) {
    lookFrom(4.0);
  }
  void lookFrom(double x) {
    world_.lookFrom({x, 2.5, 2.5});
    view_.look(world_.request.map);
  }
  VertexId vertexAt(double x) { return graph_.insertVertex({x, 2.5, 2.5}); }
  const VertexLabel& label(VertexId vertex) { return graph_.labelOf(vertex); }

  InformedParams params_;
  test::FrontierWorld world_;
  FrontierView view_;
  BarrenVoxels barren_;
  FrontierSurvey survey_;
  ReachabilityGraph graph_{4.0};
};

TEST_F(SeenCorridor, VerticesCollectTheFrontierVoxelsOfTheirBox) {
  const VertexId here = vertexAt(8.0);
  const VertexId far = vertexAt(30.0);
  EXPECT_TRUE(survey_.refresh(graph_).empty());
  std::size_t wanted = 0;
  for (const map::VoxelIndex& voxel : view_.frontier().all())
    wanted += graph_.boxOf(here).contains(view_.credible().centreOf(voxel)) ? 1 : 0;
  EXPECT_GT(wanted, 50U);
  EXPECT_EQ(label(here).frontier.size(), wanted);
  EXPECT_FALSE(label(here).is_explored);
  EXPECT_TRUE(label(far).frontier.empty());
  EXPECT_TRUE(label(far).is_explored);
}

TEST_F(SeenCorridor, VerticesWhoseFrontierWasSeenThroughAreObserved) {
  const VertexId near = vertexAt(8.0);
  const VertexId ahead = vertexAt(14.0);
  survey_.refresh(graph_);
  EXPECT_FALSE(label(near).is_explored);
  lookFrom(10.0);
  const auto observed = survey_.refresh(graph_);
  EXPECT_NE(std::find(observed.begin(), observed.end(), near), observed.end());
  EXPECT_FALSE(label(ahead).is_explored) << "the frontier has come into its box";
  EXPECT_TRUE(survey_.refresh(graph_).empty()) << "nothing has changed since";
  lookFrom(16.0);
  survey_.refresh(graph_);
  EXPECT_TRUE(label(near).is_explored) << label(near).frontier.size();
}

TEST_F(SeenCorridor, ClosedVerticesStayClosedUntilNewFrontierTurnsUp) {
  const VertexId here = vertexAt(10.0);
  survey_.refresh(graph_);
  VertexLabel& closed = graph_.update(here);
  closed.is_explored = true;
  closed.closed_because = "tried";
  for (const FrontierVoxel& voxel : closed.frontier) closed.closed_voxels.push_back(voxel.voxel);
  closed.surveyed = 0;  // as if the frontier had changed
  survey_.refresh(graph_);
  EXPECT_TRUE(label(here).is_explored);
  lookFrom(6.0);
  survey_.refresh(graph_);
  EXPECT_FALSE(label(here).is_explored);
  EXPECT_TRUE(label(here).closed_because.empty());
}

TEST_F(SeenCorridor, FrontierOutsideTheBoundsOrInAZoneDoesNotCount) {
  const VertexId here = vertexAt(8.0);
  survey_.refresh(graph_);
  const std::size_t all = label(here).frontier.size();
  world_.request.zones.push_back({"half", {{0.0, 2.5}, {40.0, 2.5}, {40.0, 5.0}, {0.0, 5.0}}});
  graph_.update(here).surveyed = 0;
  survey_.refresh(graph_);
  EXPECT_LT(label(here).frontier.size(), all);
  EXPECT_GT(label(here).frontier.size(), 0U);
  world_.request.bounds.max.x() = 5.0;
  graph_.update(here).surveyed = 0;
  survey_.refresh(graph_);
  EXPECT_TRUE(std::all_of(label(here).frontier.begin(), label(here).frontier.end(),
                          [&](const FrontierVoxel& voxel) {
                            return view_.credible().centreOf(voxel.voxel).x() <= 5.0;
                          }));
}

TEST_F(SeenCorridor, MeasuresTheClearanceOfEveryVoxel) {
  const VertexId here = vertexAt(8.0);
  survey_.refresh(graph_);
  survey_.measure(graph_, here);
  for (const FrontierVoxel& voxel : label(here).frontier)
    EXPECT_NEAR(
        static_cast<double>(voxel.clearance_m),
        FrontierView::clearanceAt(*world_.request.map, view_.credible().centreOf(voxel.voxel),
                                  params_.clearance_max_m),
        1e-4);
}

class Sampling : public SeenCorridor {
 protected:
  Sampling()
      : navigator_({}),
        boxes_(world_.robot.box_m),
        space_(world_.request, world_.robot, navigator_, boxes_) {
    here_ = vertexAt(8.0);
    survey_.refresh(graph_);
    survey_.measure(graph_, here_);
  }
  std::vector<FrontierSample> draw(int count, Region region, std::uint64_t seed = 1) {
    FrontierSampler sampler(view_.credible(), space_, params_, Rng(seed), barren_);
    return sampler.draw(here_, label(here_), count, region);
  }
  navigation::Navigator navigator_;
  map::ConfigurationSpace boxes_;
  KnownSpace space_;
  VertexId here_{};
};

TEST_F(Sampling, PlacesAreFreeNearTheirVoxelAndApart) {
  const auto samples = draw(FrontierSampler::kAll, Region::kVoid);
  ASSERT_GE(samples.size(), 3U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(space_.free().at(samples[i].place), Rejection::kNone);
    EXPECT_LE((samples[i].place - samples[i].voxel).norm(), 1.5 + 1e-9);
    EXPECT_TRUE(view_.frontier().contains(view_.credible().indexOf(samples[i].voxel)));
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE((samples[i].place - samples[k].place).norm(), params_.sample_spacing_m);
  }
}

TEST_F(Sampling, PlacesKeepTheSafeDistanceFromRockThatTheFrontierTouches) {
  const auto samples = draw(FrontierSampler::kAll, Region::kVoid);
  ASSERT_GE(samples.size(), 3U);
  for (const FrontierSample& sample : samples) EXPECT_TRUE(space_.isRoomy(sample.place));
}

TEST_F(Sampling, DrawsAsManyAsAskedForAndRepeats) {
  const auto one = draw(2, Region::kBranch);
  const auto two = draw(2, Region::kBranch);
  ASSERT_EQ(one.size(), 2U);
  EXPECT_EQ(one[0].place, two[0].place);
  EXPECT_EQ(one[1].place, two[1].place);
}

TEST_F(Sampling, FavoursTheMiddleInABranch) {
  double sum = 0.0;
  for (const FrontierVoxel& voxel : label(here_).frontier)
    sum += static_cast<double>(voxel.clearance_m);
  const double average = sum / static_cast<double>(label(here_).frontier.size());
  const auto middleDraws = [&](Region region) {
    int middle = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed)
      for (const FrontierSample& sample : draw(1, region, seed))
        middle += FrontierView::clearanceAt(*world_.request.map, sample.voxel,
                                            params_.clearance_max_m) >= average
                      ? 1
                      : 0;
    return middle;
  };
  EXPECT_GT(middleDraws(Region::kBranch), middleDraws(Region::kVoid) + 20);
}

TEST_F(Sampling, KeepsAwayFromPlacesOfBefore) {
  const auto all = draw(FrontierSampler::kAll, Region::kVoid);
  std::vector<Eigen::Vector3d> before;
  for (const FrontierSample& sample : all) before.push_back(sample.place);
  FrontierSampler sampler(view_.credible(), space_, params_, Rng(1), barren_, before);
  for (const FrontierSample& sample :
       sampler.draw(here_, label(here_), FrontierSampler::kAll, Region::kVoid))
    for (const Eigen::Vector3d& place : before)
      EXPECT_GE((sample.place - place).norm(), params_.sample_spacing_m);
}

}  // namespace
}  // namespace spelunk::planners::informed
