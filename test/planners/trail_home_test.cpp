#include "spelunk/planners/shared/trail_home.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spelunk::planners {
namespace {

/// Open space with a wall at x = 0 but for y > `gap_y`.
class ATrailRoundAWall : public ::testing::Test {
 protected:
  ATrailRoundAWall() {
    request_.home.position = {-2.0, 0.0, 1.0};
    double time_s = 0.0;
    for (const auto& [from, to] :
         {std::pair<Eigen::Vector3d, Eigen::Vector3d>{{-2, 0, 1}, {-2, 12, 1}},
          {{-1, 12, 1}, {2, 12, 1}},
          {{2, 11, 1}, {2, 0, 1}}})
      for (const Eigen::Vector3d& point : graph::resampled({from, to}, 1.0))
        request_.trail.push_back({time_s += 1.0, {point, 0.0}});
  }
  [[nodiscard]] FreeSpace space() const {
    return {[this](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
              const bool crosses = (a.x() < 0.0) != (b.x() < 0.0);
              return crosses && std::min(a.y(), b.y()) < gap_y_ ? map::Occupancy::kOccupied
                                                                : map::Occupancy::kFree;
            },
            {1.0, 1.0, 0.4},
            request_.bounds,
            request_.zones};
  }

  PlanRequest request_;
  double gap_y_ = 11.0;
  TrailHome home_;
};

TEST_F(ATrailRoundAWall, LeadsHomeTheWayItCameWithCornersCut) {
  const Eigen::Vector3d root(3.0, 0.5, 1.0);
  home_.follow(request_, root, space());
  const graph::Polyline way = home_.findWay(space());
  ASSERT_GE(way.size(), 2U);
  EXPECT_EQ(way.front(), root);
  EXPECT_EQ(way.back(), request_.home.position);
  EXPECT_NEAR(graph::lengthOf(way), home_.metres(), 1e-9);
  const double as_flown = 12.0 + 4.0 + 12.0;
  const double shortest = 2.0 * std::hypot(11.0, 2.0);
  EXPECT_LT(home_.metres(), as_flown);
  EXPECT_GT(home_.metres(), shortest);
}

TEST_F(ATrailRoundAWall, TakesANewShortCutAndGivesUpABlockedOne) {
  home_.follow(request_, {3.0, 0.0, 1.0}, space());
  gap_y_ = 20.0;  // the gap has fallen in
  EXPECT_TRUE(home_.findWay(space()).empty());
  gap_y_ = -5.0;  // and the wall is gone
  home_.follow(request_, {1.5, 0.0, 1.0}, space());
  EXPECT_NEAR(home_.metres(), 3.5, 0.2);
}

TEST_F(ATrailRoundAWall, KnowsTheWayFromTheEndOfAPathThatWasNotFlownYet) {
  home_.follow(request_, {2.0, 0.0, 1.0}, space());
  home_.expect({{2.0, 0.0, 1.0}, {30.0, 0.0, 1.0}}, space());
  home_.follow(request_, {30.0, 0.0, 1.0}, space());
  const double from_trail = home_.metres() - 28.0;
  home_.follow(request_, {2.0, 0.0, 1.0}, space());
  EXPECT_NEAR(home_.metres(), from_trail, 2.0);
}

TEST_F(ATrailRoundAWall, HasNoWayFromAPlaceItCannotBeReachedFrom) {
  home_.follow(request_, {90.0, 0.0, 1.0}, space());
  EXPECT_TRUE(std::isinf(home_.metres()));
  EXPECT_TRUE(home_.findWay(space()).empty());
}

TEST_F(ATrailRoundAWall, IsTakenUpFromItsLayer) {
  home_.follow(request_, {2.0, 0.0, 1.0}, space());
  TrailHome restored;
  restored.restore(home_.layer());
  EXPECT_EQ(home_.layer().name, "trail");
  PlanRequest later = request_;
  later.trail.clear();
  restored.follow(later, {2.0, 0.0, 1.0}, space());
  EXPECT_NEAR(restored.metres(), home_.metres(), 1e-9);
}

}  // namespace
}  // namespace spelunk::planners
