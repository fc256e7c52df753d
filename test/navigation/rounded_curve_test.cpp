#include "spelunk/navigation/rounded_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/rng.h"

namespace spelunk::navigation {
namespace {

TEST(RoundedCurve, TangentsNeverJumpExceptAtCusps) {
  Rng rng(5);
  Path path{{Eigen::Vector3d::Zero(), 0.0}};
  for (int k = 0; k < 30; ++k)
    path.push_back({path.back().position +
                        Eigen::Vector3d(rng.uniform(-2, 3), rng.uniform(-2, 2), rng.uniform(-1, 1)),
                    0.0});
  const auto curve = roundedCurve(path, 0.3, 0.05);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    EXPECT_GT(curve[i].arc_m, curve[i - 1].arc_m);
    if (curve[i - 1].is_cusp || curve[i].is_cusp) continue;
    const double step = curve[i].arc_m - curve[i - 1].arc_m;
    const double bend = std::max(curve[i].curvature.norm(), curve[i - 1].curvature.norm());
    EXPECT_LE((curve[i].tangent - curve[i - 1].tangent).norm(), bend * step + 1e-6);
  }
}

TEST(RoundedCurve, RightAngleDeviatesByAtMostTheTolerance) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{5.0, 0.0, 0.0}, 0.0}, {{5.0, 5.0, 0.0}, 0.0}};
  for (const double tolerance : {0.05, 0.2, 0.5}) {
    double widest = 0.0;
    double nearest_to_corner = 1e9;
    for (const CurveSample& sample : roundedCurve(path, tolerance, 0.02)) {
      widest = std::max(widest, project(path, sample.position).distance_m);
      nearest_to_corner = std::min(nearest_to_corner, (sample.position - path[1].position).norm());
    }
    EXPECT_LE(widest, tolerance);
    EXPECT_LE(nearest_to_corner, tolerance);
    EXPECT_GT(nearest_to_corner, 0.3 * tolerance);
  }
}

TEST(RoundedCurve, SharpReversalIsACusp) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{3.0, 0.0, 0.0}, 0.0}, {{0.0, 0.1, 0.0}, 0.0}};
  int cusps = 0;
  for (const CurveSample& sample : roundedCurve(path, 0.05, 0.05)) cusps += sample.is_cusp ? 1 : 0;
  EXPECT_EQ(cusps, 1);
}

TEST(Straightened, DropsWaypointsWithinToleranceOnly) {
  const Path path{{{0.0, 0.0, 0.0}, 0.0}, {{1.0, 0.02, 0.0}, 0.0}, {{2.0, 0.0, 0.0}, 0.0},
                  {{3.0, 0.5, 0.0}, 0.0}, {{4.0, 0.0, 0.0}, 0.0},  {{4.0, 0.0, 0.0}, 0.0}};
  const auto points = straightened(path, 0.05);
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[1], path[2].position);
  EXPECT_EQ(points[2], path[3].position);
}

}  // namespace
}  // namespace spelunk::navigation
