#include "spelunk/graph/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"

namespace spelunk::graph {
namespace {

Eigen::Vector3d drawPoint(Rng& rng) {
  const double x = rng.uniform(-10.0, 10.0);
  const double y = rng.uniform(-10.0, 10.0);
  return {x, y, rng.uniform(-2.0, 2.0)};
}

std::vector<std::size_t> withinByBruteForce(const std::vector<Eigen::Vector3d>& points,
                                            const Eigen::Vector3d& query, double radius_m) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[i] - query).squaredNorm() < radius_m * radius_m) indices.push_back(i);
  }
  std::stable_sort(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
    return (points[a] - query).squaredNorm() < (points[b] - query).squaredNorm();
  });
  return indices;
}

TEST(PointIndex, FindsNothingWhileEmpty) {
  const PointIndex index;
  EXPECT_FALSE(index.findNearest(Eigen::Vector3d::Zero()).has_value());
  EXPECT_TRUE(index.findWithin(Eigen::Vector3d::Zero(), 5.0).empty());
}

TEST(PointIndex, RefusesAPointThatIsNotFinite) {
  PointIndex index;
  EXPECT_THROW(index.add({0.0, std::nan(""), 0.0}), Precondition);
}

TEST(PointIndex, AgreesWithBruteForceWhilePointsArrive) {
  Rng rng(5);
  PointIndex index;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 600; ++i) {
    points.push_back(drawPoint(rng));
    index.add(points.back());
    if (i % 7 != 0) continue;
    const Eigen::Vector3d query = drawPoint(rng);
    const auto expected = withinByBruteForce(points, query, 1e3);
    ASSERT_EQ(*index.findNearest(query), expected.front());
    ASSERT_EQ(index.findWithin(query, 3.0), withinByBruteForce(points, query, 3.0));
  }
}

TEST(PointIndex, OrdersEqualDistancesByIndex) {
  PointIndex index;
  for (const double x : {1.0, -1.0, 1.0, -1.0}) index.add({x, 0.0, 0.0});
  EXPECT_EQ(index.findWithin(Eigen::Vector3d::Zero(), 2.0), (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(PointIndex, KeepsItsPointsWhenMoved) {
  PointIndex index;
  index.add({1.0, 2.0, 3.0});
  const PointIndex moved = std::move(index);
  EXPECT_EQ(*moved.findNearest({1.0, 2.0, 2.0}), 0U);
}

}  // namespace
}  // namespace spelunk::graph
