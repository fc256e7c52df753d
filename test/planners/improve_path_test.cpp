#include "spelunk/planners/gbplanner/improve_path.h"

#include <gtest/gtest.h>

#include "spelunk/map/configuration_space.h"
#include "support/grid_world.h"

namespace spelunk::planners::gbplanner {
namespace {

const Eigen::Vector3d kBox(1.0, 1.0, 0.4);

/// A corridor 3 m wide and high along x, all of it known; its axis is y = 2.5, z = 2.5.
class ACorridor : public ::testing::Test {
 protected:
  ACorridor() {
    map::MapParams params;
    params.resolution_m = 0.25;
    params.range_min_m = 0.0;
    map::OccupancyMap map(params);
    test::corridorWorld(24.0).enterInto(map);
    frozen_ = map.freeze();
    inflated_ = std::make_unique<map::ConfigurationSpace>(kBox, frozen_);
  }
  [[nodiscard]] FreeSpace space() const {
    return {[this](const auto& a, const auto& b) { return inflated_->sweep(a, b); }, kBox, bounds_,
            zones_};
  }

  AxisAlignedBox bounds_;
  std::vector<NoGoZone> zones_;
  std::shared_ptr<const map::FrozenMap> frozen_;
  std::unique_ptr<map::ConfigurationSpace> inflated_;
};

TEST_F(ACorridor, HasItsRoomiestPointOnItsAxis) {
  const Eigen::Vector3d moved = roomiestPoint({5.0, 1.8, 2.0}, {9.0, 1.8, 2.0}, *frozen_, 3.0);
  EXPECT_NEAR(moved.x(), 9.0, 1e-9);
  EXPECT_NEAR(moved.y(), 2.5, 0.15);
  EXPECT_NEAR(moved.z(), 2.5, 0.15);
}

TEST_F(ACorridor, LeavesAnEdgeWithoutLengthAlone) {
  const Eigen::Vector3d point(5.0, 1.8, 2.0);
  EXPECT_EQ(roomiestPoint(point, point, *frozen_, 3.0), point);
}

TEST_F(ACorridor, MovesAPathAwayFromItsWallsAndKeepsItFree) {
  const graph::Polyline path{{3, 1.8, 1.8}, {7, 3.2, 1.8}, {11, 1.8, 3.2}, {15, 1.8, 1.8}};
  const FreeSpace free = space();
  const graph::Polyline improved = improvedPath(path, free, *frozen_, {3.0, 0.5, 3.0});
  ASSERT_GE(improved.size(), 2U);
  EXPECT_EQ(improved.front(), path.front());
  for (std::size_t i = 1; i < improved.size(); ++i) {
    EXPECT_TRUE(free.isFree(improved[i - 1], improved[i]));
    EXPECT_NEAR(improved[i].y(), 2.5, 0.3);
  }
}

TEST_F(ACorridor, IsShortenedToFewStraightSegmentsWithinTheLimit) {
  const graph::Polyline path{{3, 2, 2}, {4, 3, 2}, {5, 2, 3}, {6, 3, 2}, {7, 2, 2}};
  EXPECT_EQ(shortened(path, space(), 8.0).size(), 2U);
  for (const double limit : {2.5, 4.0}) {
    const graph::Polyline shorter = shortened(path, space(), limit);
    for (std::size_t i = 1; i < shorter.size(); ++i)
      EXPECT_LE((shorter[i] - shorter[i - 1]).norm(), limit);
  }
}

TEST_F(ACorridor, IsNotCutThroughANoGoZone) {
  zones_.push_back({"pit", {{4.5, 2.0}, {5.5, 2.0}, {5.5, 5.0}, {4.5, 5.0}}});
  const graph::Polyline around{{3, 3.2, 2}, {4, 1.0, 2}, {6, 1.0, 2}, {7, 3.2, 2}};
  EXPECT_GT(shortened(around, space(), 8.0).size(), 2U);
}

TEST_F(ACorridor, LosesShortEdgesButNeitherEnd) {
  const graph::Polyline path{{3, 2, 2}, {3.2, 2, 2}, {5, 2, 2}, {5.3, 2, 2}};
  const graph::Polyline kept = pruned(path, space(), 0.5);
  EXPECT_EQ(kept, (graph::Polyline{{3, 2, 2}, {5, 2, 2}, {5.3, 2, 2}}));
}

}  // namespace
}  // namespace spelunk::planners::gbplanner
