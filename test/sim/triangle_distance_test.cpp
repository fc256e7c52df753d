#include "spelunk/sim/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "spelunk/common/rng.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

Vector3d randomPoint(Rng& rng, double reach) {
  const double x = rng.uniform(-reach, reach);
  const double y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

Triangle randomTriangle(Rng& rng, double reach) {
  return {randomPoint(rng, reach), randomPoint(rng, reach), randomPoint(rng, reach)};
}

/// Smallest distance from a dense set of the triangle's points to the box (a point if half is 0).
double sampledDistance(const Vector3d& half, const Triangle& triangle, int divisions) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= divisions; ++i)
    for (int j = 0; i + j <= divisions; ++j) {
      const double u = static_cast<double>(i) / divisions;
      const double v = static_cast<double>(j) / divisions;
      const Vector3d point =
          triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]);
      best = std::min(best, (point.cwiseAbs() - half).cwiseMax(0.0).norm());
    }
  return best;
}

TEST(TriangleDistance, KnowsFaceEdgeAndCorner) {
  const Triangle triangle{Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 2, 0)};
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({0.5, 0.5, 3.0}, triangle), 9.0);
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({1.0, -2.0, 0.0}, triangle), 4.0);
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({2.0, 2.0, 0.0}, triangle), 2.0);
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({-3.0, -4.0, 0.0}, triangle), 25.0);
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({0.3, 0.3, 0.0}, triangle), 0.0);
}

TEST(TriangleDistance, AcceptsDegenerateTriangles) {
  const Triangle segment{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(2, 0, 0)};
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({1.5, 2.0, 0.0}, segment), 4.0);
  const Triangle point{Vector3d(1, 1, 1), Vector3d(1, 1, 1), Vector3d(1, 1, 1)};
  EXPECT_DOUBLE_EQ(pointTriangleDistanceSquared({1.0, 1.0, 3.0}, point), 4.0);
  EXPECT_DOUBLE_EQ(boxTriangleDistanceSquared({0.5, 0.5, 0.5}, point), 0.75);
}

TEST(TriangleDistance, PointAgreesWithSampling) {
  Rng rng(11);
  for (int trial = 0; trial < 300; ++trial) {
    const Triangle triangle = randomTriangle(rng, 2.0);
    const Vector3d point = randomPoint(rng, 3.0);
    const Triangle relative{triangle[0] - point, triangle[1] - point, triangle[2] - point};
    const double sampled = sampledDistance(Vector3d::Zero(), relative, 60);
    const double exact = std::sqrt(pointTriangleDistanceSquared(point, triangle));
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_GE(exact, sampled - 0.1);  // half the samples' spacing along the longest edge
  }
}

TEST(TriangleDistance, BoxAgreesWithSampling) {
  Rng rng(12);
  int overlapping = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Vector3d half(rng.uniform(0.1, 1.0), rng.uniform(0.1, 1.0), rng.uniform(0.1, 1.0));
    const Triangle triangle = randomTriangle(rng, 3.0);
    const double sampled = sampledDistance(half, triangle, 80);
    const double exact = std::sqrt(boxTriangleDistanceSquared(half, triangle));
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_GE(exact, sampled - 0.11);
    if (sampled == 0.0) {
      EXPECT_EQ(exact, 0.0);
      ++overlapping;
    }
  }
  EXPECT_GT(overlapping, 40);
}

TEST(TriangleDistance, BoxInsideAHugeTrianglesPlaneIsMet) {
  const Triangle floor{Vector3d(-100, -100, 0.2), Vector3d(100, -100, 0.2), Vector3d(0, 150, 0.2)};
  EXPECT_EQ(boxTriangleDistanceSquared({0.5, 0.5, 0.25}, floor), 0.0);
  EXPECT_NEAR(std::sqrt(boxTriangleDistanceSquared({0.5, 0.5, 0.15}, floor)), 0.05, 1e-12);
}

}  // namespace
}  // namespace spelunk::sim
