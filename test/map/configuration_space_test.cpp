#include "spelunk/map/configuration_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr double kTolerance = 1e-4;

/// By definition: every voxel the box touches by more than the tolerance, one by one.
Occupancy plainBox(const FrozenMap& map, const Eigen::Vector3d& centre,
                   const Eigen::Vector3d& size) {
  const VoxelIndex first =
      map.indexOf(Eigen::Vector3d(centre - (0.5 * size.array() - kTolerance).matrix()));
  const VoxelIndex last =
      map.indexOf(Eigen::Vector3d(centre + (0.5 * size.array() - kTolerance).matrix()));
  Occupancy worst = Occupancy::kFree;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const Occupancy status = map.at(VoxelIndex(x, y, z));
        if (status == Occupancy::kOccupied) return status;
        if (status == Occupancy::kUnknown) worst = status;
      }
  return worst;
}

struct Case {
  Eigen::Vector3d box;
  double resolution_m;
  VoxelIndex voxels;
};

class ConfigurationSpaceOf : public testing::TestWithParam<Case> {
 protected:
  ConfigurationSpaceOf() {
    MapParams params;
    params.resolution_m = GetParam().resolution_m;
    map_ = std::make_unique<OccupancyMap>(randomMap(params, rng_, GetParam().voxels, 0.002, 0.003));
    extent_ = GetParam().voxels.cast<double>() * params.resolution_m;
    view_ = map_->freeze();
  }
  Eigen::Vector3d anywhere() {
    return {rng_.uniform(-0.5, extent_.x() + 0.5), rng_.uniform(-0.5, extent_.y() + 0.5),
            rng_.uniform(-0.5, extent_.z() + 0.5)};
  }
  Eigen::Vector3d onGrid(const Eigen::Vector3d& point) const {
    return view_->centreOf(view_->indexOf(point));
  }

  Rng rng_{21};
  std::unique_ptr<OccupancyMap> map_;
  std::shared_ptr<const FrozenMap> view_;
  Eigen::Vector3d extent_;
};

TEST_P(ConfigurationSpaceOf, BoxAnswersEqualLookingAtEachVoxel) {
  ConfigurationSpace space(GetParam().box, view_);
  int free = 0;
  int occupied = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d centre = i % 2 == 0 ? anywhere() : onGrid(anywhere());
    const Occupancy wanted = plainBox(*view_, centre, GetParam().box);
    ASSERT_EQ(space.boxAt(centre), wanted) << centre.transpose();
    ASSERT_EQ(space.isFree(centre), wanted == Occupancy::kFree);
    free += wanted == Occupancy::kFree ? 1 : 0;
    occupied += wanted == Occupancy::kOccupied ? 1 : 0;
  }
  EXPECT_GT(free, 200);
  EXPECT_GT(occupied, 50);
}

TEST_P(ConfigurationSpaceOf, FreeSweepsTouchNoBlockedVoxelAtMuchFinerSteps) {
  ConfigurationSpace space(GetParam().box, view_);
  int free = 0;
  for (int i = 0; i < 4000 && free < 150; ++i) {
    const bool is_on_grid = i % 3 == 0;
    const Eigen::Vector3d a = is_on_grid ? onGrid(anywhere()) : anywhere();
    Eigen::Vector3d b = a + (anywhere() - 0.5 * extent_) * 0.6;
    if (is_on_grid) b = onGrid(b);
    if (i % 7 == 0) b.x() = a.x();
    if (!space.isSweepFree(a, b)) continue;
    ++free;
    const int steps = static_cast<int>((b - a).norm() / (0.01 * GetParam().resolution_m)) + 1;
    // A billionth smaller, so that rounding of the steps cannot push a face over a border.
    const Eigen::Vector3d box = GetParam().box.array() - 1e-9;
    for (int k = 0; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      ASSERT_EQ(plainBox(*view_, a + (b - a) * share, box), Occupancy::kFree)
          << a.transpose() << " to " << b.transpose() << " at " << share;
    }
  }
  EXPECT_GE(free, 40);
}

TEST_P(ConfigurationSpaceOf, RefusedSweepsReallyTouchABlockedVoxel) {
  ConfigurationSpace space(GetParam().box, view_);
  int refused = 0;
  for (int i = 0; i < 3000 && refused < 300; ++i) {
    const Eigen::Vector3d a = anywhere();
    const Eigen::Vector3d b = a + (anywhere() - 0.5 * extent_) * 0.4;
    if (space.isSweepFree(a, b) || !space.isFree(a)) continue;
    ++refused;
    // Slightly larger, so that the finite steps cannot miss a corner the sweep clips.
    const double step = 0.002 * GetParam().resolution_m;
    const Eigen::Vector3d larger = GetParam().box.array() + 2.0 * step;
    const int steps = static_cast<int>((b - a).norm() / step) + 1;
    bool is_blocked = false;
    for (int k = 0; k <= steps && !is_blocked; ++k)
      is_blocked = plainBox(*view_, a + (b - a) * (static_cast<double>(k) / steps), larger) !=
                   Occupancy::kFree;
    ASSERT_TRUE(is_blocked) << a.transpose() << " to " << b.transpose();
  }
  EXPECT_GE(refused, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Boxes, ConfigurationSpaceOf,
    testing::Values(Case{{1.4, 1.4, 0.5}, 0.2, {40, 36, 14}},
                    Case{{1.1, 1.1, 0.4}, 0.2, {70, 30, 10}},
                    Case{{0.6, 0.8, 0.4}, 0.2, {66, 20, 12}},  // whole multiples of the voxel
                    Case{{0.6002, 0.4002, 0.2002}, 0.2, {30, 30, 8}},  // the same, less tolerance
                    Case{{0.11, 0.15, 0.05}, 0.2, {30, 20, 8}}));      // smaller than a voxel

TEST(ConfigurationSpace, BoxWiderThanAChunk) {
  MapParams params;
  params.resolution_m = 0.1;
  OccupancyMap map(params);
  map.markFree({{0.0, 0.0, 0.0}, {15.0, 2.0, 1.0}});
  ConfigurationSpace space({7.0, 1.0, 0.5}, map.freeze());
  EXPECT_TRUE(space.isSweepFree({3.6, 1.0, 0.5}, {11.4, 1.0, 0.5}));
  EXPECT_FALSE(space.isFree({3.4, 1.0, 0.5}));
  EXPECT_FALSE(space.isSweepFree({3.6, 1.0, 0.5}, {11.6, 1.0, 0.5}));
  EXPECT_EQ(space.inflations(), 0U);
}

TEST(ConfigurationSpace, SaysWhyASweepIsRefused) {
  MapParams params;
  params.range_min_m = 0.0;
  OccupancyMap map(params);
  map.markFree({{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}});
  occupy(map, {15, 5, 5});
  ConfigurationSpace space({0.4, 0.4, 0.4}, map.freeze());
  const Eigen::Vector3d start(1.1, 1.1, 1.1);
  EXPECT_EQ(space.sweep(start, {2.0, 1.1, 1.1}), Occupancy::kFree);
  EXPECT_EQ(space.sweep(start, {3.6, 1.1, 1.1}), Occupancy::kOccupied);
  EXPECT_EQ(space.sweep(start, {1.1, 2.1, 1.1}), Occupancy::kUnknown);
  EXPECT_EQ(space.sweep(start, {1.1, 1e9, 1.1}), Occupancy::kUnknown);
}

TEST(ConfigurationSpace, OddCoordinatesAreUnknownNeverFree) {
  OccupancyMap map{MapParams{}};
  map.markFree({{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}});
  ConfigurationSpace space({0.4, 0.4, 0.4}, map.freeze());
  const Eigen::Vector3d inside(1.0, 1.0, 1.0);
  for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    EXPECT_FALSE(space.isFree({odd, 1.0, 1.0}));
    EXPECT_EQ(space.boxAt({1.0, odd, 1.0}), Occupancy::kUnknown);
    EXPECT_FALSE(space.isSweepFree(inside, {odd, 1.0, 1.0}));
    EXPECT_FALSE(space.isSweepFree({1.0, 1.0, odd}, inside));
  }
  EXPECT_TRUE(space.isSweepFree(inside, inside));
  EXPECT_THROW(ConfigurationSpace({0.0, 0.4, 0.4}), Precondition);
  EXPECT_THROW(static_cast<void>(ConfigurationSpace({1.0, 1.0, 1.0}).isFree(inside)), Precondition);
}

TEST(ConfigurationSpace, UnknownMayBeEnteredIfAskedFor) {
  MapParams params;
  params.range_min_m = 0.0;
  OccupancyMap map(params);
  map.markFree({{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}});
  occupy(map, {15, 5, 5});
  const Eigen::Vector3d box(0.4, 0.4, 0.4);
  ConfigurationSpace known(box, map.freeze());
  ConfigurationSpace open(box, map.freeze(), Passable::kNotOccupied);
  const Eigen::Vector3d start(1.1, 1.1, 1.1);
  EXPECT_FALSE(known.isSweepFree(start, {1.1, 30.0, 1.1}));
  EXPECT_TRUE(open.isSweepFree(start, {1.1, 30.0, 1.1}));
  EXPECT_EQ(open.sweep(start, {3.6, 1.1, 1.1}), Occupancy::kOccupied);
}

TEST(ConfigurationSpace, LaterMapsAreAnsweredLikeFreshOnes) {
  Rng rng(5);
  OccupancyMap map{MapParams{}};
  const Eigen::Vector3d box(1.1, 1.1, 0.4);
  ConfigurationSpace kept(box);
  for (int scan = 0; scan < 12; ++scan) {
    map.insert(hallScan(rng, hallPosition(scan), 3000), noBody());
    kept.use(map.freeze());
    ConfigurationSpace fresh(box, map.freeze());
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d a(rng.uniform(-9.5, 11.5), rng.uniform(-4.5, 5.5),
                              rng.uniform(-1.0, 3.2));
      const Eigen::Vector3d b =
          a + Eigen::Vector3d(rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), 0.1);
      ASSERT_EQ(kept.sweep(a, b), fresh.sweep(a, b)) << scan;
    }
  }
  const std::size_t before = kept.inflations();
  map.markFree({{60.0, 60.0, 60.0}, {61.0, 61.0, 61.0}});
  kept.use(map.freeze());
  static_cast<void>(kept.boxAt({0.0, 0.0, 0.5}));
  EXPECT_EQ(kept.inflations(), before);  // nothing near it changed
}

}  // namespace
}  // namespace spelunk::map
