#include "spelunk/graph/path_similarity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::graph {
namespace {

Polyline drawLine(Rng& rng, int points) {
  Polyline line;
  for (int i = 0; i < points; ++i) {
    const double x = rng.uniform(0.0, 5.0);
    line.emplace_back(x, rng.uniform(0.0, 5.0), 0.0);
  }
  return line;
}

/// All monotone pairings, tried one by one.
double warpedByRecursion(const Polyline& a, const Polyline& b, std::size_t i, std::size_t j) {
  const double here = (a[i] - b[j]).norm();
  if (i + 1 == a.size() && j + 1 == b.size()) return here;
  double rest = std::numeric_limits<double>::infinity();
  if (i + 1 < a.size()) rest = std::min(rest, warpedByRecursion(a, b, i + 1, j));
  if (j + 1 < b.size()) rest = std::min(rest, warpedByRecursion(a, b, i, j + 1));
  if (i + 1 < a.size() && j + 1 < b.size())
    rest = std::min(rest, warpedByRecursion(a, b, i + 1, j + 1));
  return here + rest;
}

TEST(DtwDistance, EqualsTheBestOfAllPairings) {
  Rng rng(3);
  for (int round = 0; round < 30; ++round) {
    const Polyline a = drawLine(rng, 1 + rng.below(6));
    const Polyline b = drawLine(rng, 1 + rng.below(6));
    EXPECT_NEAR(dtwDistance(a, b), warpedByRecursion(a, b, 0, 0), 1e-9);
    EXPECT_NEAR(dtwDistance(a, b), dtwDistance(b, a), 1e-9);
  }
}

TEST(DtwDistance, ComparesPointByPointAndNotJustTheEnds) {
  const Polyline straight{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  const Polyline bulging{{0, 0, 0}, {1, 2, 0}, {2, 3, 0}, {3, 2, 0}, {4, 0, 0}};
  EXPECT_DOUBLE_EQ(dtwDistance(straight, straight), 0.0);
  EXPECT_GT(dtwDistance(straight, bulging), 5.0);
  EXPECT_THROW(static_cast<void>(dtwDistance({}, straight)), Precondition);
}

TEST(Resampled, KeepsEndsAndSpacingAroundCorners) {
  const Polyline line = resampled({{0, 0, 0}, {2.5, 0, 0}, {2.5, 2.0, 0}}, 1.0);
  ASSERT_EQ(line.size(), 6U);
  EXPECT_TRUE(line[3].isApprox(Eigen::Vector3d(2.5, 0.5, 0.0)));
  EXPECT_TRUE(line.back().isApprox(Eigen::Vector3d(2.5, 2.0, 0.0)));
  EXPECT_EQ(resampled({{1, 1, 1}}, 0.5).size(), 1U);
  EXPECT_THROW(static_cast<void>(resampled({}, 1.0)), Precondition);
  EXPECT_THROW(static_cast<void>(resampled({{1, 1, 1}}, 0.0)), Precondition);
}

TEST(ClusterPaths, GroupsBranchesAndNamesTheLongestOfEach) {
  const std::vector<Polyline> paths{{{0, 0, 0}, {6, 0.3, 0}},   // east
                                    {{0, 0, 0}, {0.2, 9, 0}},   // north, the longest there
                                    {{0, 0, 0}, {10, 0, 0}},    // east, the longest there
                                    {{0, 0, 0}, {-0.3, 5, 0}},  // north
                                    {{0, 0, 0}, {7, 0, 0.2}}};  // east
  const std::vector<PathCluster> clusters = clusterPaths(paths, 1.0, 1.0);
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters[0].principal, 2U);
  EXPECT_EQ(clusters[0].members, (std::vector<std::size_t>{2, 4, 0}));
  EXPECT_EQ(clusters[1].principal, 1U);
  EXPECT_EQ(clusters[1].members, (std::vector<std::size_t>{1, 3}));
}

TEST(ClusterPaths, HasNoClusterForNoPath) { EXPECT_TRUE(clusterPaths({}, 1.0, 1.0).empty()); }

}  // namespace
}  // namespace spelunk::graph
