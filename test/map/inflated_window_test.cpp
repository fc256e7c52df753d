#include "spelunk/map/inflated_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "map_worlds.h"
#include "spelunk/common/contract.h"

namespace spelunk::map {
namespace {

constexpr double kTolerance = 1e-4;

/// By definition: every voxel the box touches by more than the tolerance, one by one.
Occupancy plainBox(const LocalWindow& window, const Eigen::Vector3d& centre,
                   const Eigen::Vector3d& size) {
  const VoxelIndex first =
      window.indexOf(Eigen::Vector3d(centre - (0.5 * size.array() - kTolerance).matrix()));
  const VoxelIndex last =
      window.indexOf(Eigen::Vector3d(centre + (0.5 * size.array() - kTolerance).matrix()));
  Occupancy worst = Occupancy::kFree;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const Occupancy status = window.at(VoxelIndex(x, y, z));
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

class InflatedWindowOf : public testing::TestWithParam<Case> {
 protected:
  InflatedWindowOf() {
    MapParams params;
    params.resolution_m = GetParam().resolution_m;
    map_ = std::make_unique<OccupancyMap>(randomMap(params, rng_, GetParam().voxels, 0.002, 0.003));
    const Eigen::Vector3d size = GetParam().voxels.cast<double>() * params.resolution_m;
    window_ = std::make_unique<LocalWindow>(
        *map_->freeze(), AxisAlignedBox{Eigen::Vector3d::Constant(-0.3), size.array() + 0.3});
    extent_ = size;
  }
  Eigen::Vector3d anywhere() {
    return {rng_.uniform(-0.5, extent_.x() + 0.5), rng_.uniform(-0.5, extent_.y() + 0.5),
            rng_.uniform(-0.5, extent_.z() + 0.5)};
  }
  Eigen::Vector3d onGrid(const Eigen::Vector3d& point) const {
    return window_->centreOf(window_->indexOf(point));
  }

  Rng rng_{21};
  std::unique_ptr<OccupancyMap> map_;
  std::unique_ptr<LocalWindow> window_;
  Eigen::Vector3d extent_;
};

TEST_P(InflatedWindowOf, BoxAnswersEqualLookingAtEachVoxel) {
  const InflatedWindow inflated(*window_, GetParam().box);
  int free = 0;
  int occupied = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d centre = i % 2 == 0 ? anywhere() : onGrid(anywhere());
    const Occupancy wanted = plainBox(*window_, centre, GetParam().box);
    ASSERT_EQ(inflated.boxAt(centre), wanted) << centre.transpose();
    ASSERT_EQ(inflated.isFree(centre), wanted == Occupancy::kFree);
    free += wanted == Occupancy::kFree ? 1 : 0;
    occupied += wanted == Occupancy::kOccupied ? 1 : 0;
  }
  EXPECT_GT(free, 200);
  EXPECT_GT(occupied, 50);
}

TEST_P(InflatedWindowOf, FreeSweepsTouchNoBlockedVoxelAtMuchFinerSteps) {
  const InflatedWindow inflated(*window_, GetParam().box);
  int free = 0;
  for (int i = 0; i < 4000 && free < 150; ++i) {
    const bool is_on_grid = i % 3 == 0;
    const Eigen::Vector3d a = is_on_grid ? onGrid(anywhere()) : anywhere();
    Eigen::Vector3d b = a + (anywhere() - 0.5 * extent_) * 0.6;
    if (is_on_grid) b = onGrid(b);
    if (i % 7 == 0) b.x() = a.x();
    if (!inflated.isSweepFree(a, b)) continue;
    ++free;
    const int steps = static_cast<int>((b - a).norm() / (0.01 * GetParam().resolution_m)) + 1;
    // A billionth smaller, so that rounding of the steps cannot push a face over a border.
    const Eigen::Vector3d box = GetParam().box.array() - 1e-9;
    for (int k = 0; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      ASSERT_EQ(plainBox(*window_, a + (b - a) * share, box), Occupancy::kFree)
          << a.transpose() << " to " << b.transpose() << " at " << share;
    }
  }
  EXPECT_GE(free, 40);
}

TEST_P(InflatedWindowOf, RefusedSweepsReallyTouchABlockedVoxel) {
  const InflatedWindow inflated(*window_, GetParam().box);
  int refused = 0;
  for (int i = 0; i < 3000 && refused < 300; ++i) {
    const Eigen::Vector3d a = anywhere();
    const Eigen::Vector3d b = a + (anywhere() - 0.5 * extent_) * 0.4;
    if (inflated.isSweepFree(a, b) || !inflated.isFree(a)) continue;
    ++refused;
    // Slightly larger, so that the finite steps cannot miss a corner the sweep clips.
    const double step = 0.002 * GetParam().resolution_m;
    const Eigen::Vector3d larger = GetParam().box.array() + 2.0 * step;
    const int steps = static_cast<int>((b - a).norm() / step) + 1;
    bool is_blocked = false;
    for (int k = 0; k <= steps && !is_blocked; ++k)
      is_blocked = plainBox(*window_, a + (b - a) * (static_cast<double>(k) / steps), larger) !=
                   Occupancy::kFree;
    ASSERT_TRUE(is_blocked) << a.transpose() << " to " << b.transpose();
  }
  EXPECT_GE(refused, 100);
}

TEST_P(InflatedWindowOf, NotOccupiedLetsThroughTheUnknownAndStopsAtTheRim) {
  const InflatedWindow open(*window_, GetParam().box, Passable::kNotOccupied);
  int unknown = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d centre = i % 2 == 0 ? anywhere() : onGrid(anywhere());
    const Occupancy plain = plainBox(*window_, centre, GetParam().box);
    const Eigen::Vector3d half = 0.5 * GetParam().box.array() - 1e-4;
    const bool is_inside =
        ((window_->indexOf(centre - half) - window_->origin()).array() >= 0).all() &&
        ((window_->indexOf(centre + half) - window_->origin()).array() < window_->size().array())
            .all();
    ASSERT_EQ(open.isFree(centre), is_inside && plain != Occupancy::kOccupied)
        << centre.transpose();
    unknown += open.isFree(centre) && plain == Occupancy::kUnknown ? 1 : 0;
  }
  EXPECT_GT(unknown, 20);
}

INSTANTIATE_TEST_SUITE_P(
    Boxes, InflatedWindowOf,
    testing::Values(Case{{1.4, 1.4, 0.5}, 0.2, {40, 36, 14}},
                    Case{{1.1, 1.1, 0.4}, 0.2, {70, 30, 10}},
                    Case{{0.6, 0.8, 0.4}, 0.2, {66, 20, 12}},  // whole multiples of the voxel
                    Case{{0.6002, 0.4002, 0.2002}, 0.2, {30, 30, 8}},  // the same, less tolerance
                    Case{{0.11, 0.15, 0.05}, 0.2, {30, 20, 8}}));      // smaller than a voxel

TEST(InflatedWindow, BoxWiderThanAWordOfBits) {
  MapParams params;
  params.resolution_m = 0.1;
  OccupancyMap map(params);
  map.markFree({{0.0, 0.0, 0.0}, {15.0, 2.0, 1.0}});
  const LocalWindow window(*map.freeze(), {{-1.0, -1.0, -1.0}, {16.0, 3.0, 2.0}});
  const InflatedWindow inflated(window, {7.0, 1.0, 0.5});
  EXPECT_TRUE(inflated.isSweepFree({3.6, 1.0, 0.5}, {11.4, 1.0, 0.5}));
  EXPECT_FALSE(inflated.isFree({3.4, 1.0, 0.5}));
  EXPECT_FALSE(inflated.isSweepFree({3.6, 1.0, 0.5}, {11.6, 1.0, 0.5}));
}

TEST(InflatedWindow, SaysWhyASweepIsRefused) {
  MapParams params;
  params.range_min_m = 0.0;
  OccupancyMap map(params);
  map.markFree({{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}});
  occupy(map, {15, 5, 5});
  const LocalWindow window(*map.freeze(), {{-2.0, -2.0, -2.0}, {6.0, 4.0, 4.0}});
  const InflatedWindow inflated(window, {0.4, 0.4, 0.4});
  const Eigen::Vector3d start(1.1, 1.1, 1.1);
  EXPECT_EQ(inflated.sweep(start, {2.0, 1.1, 1.1}), Occupancy::kFree);
  EXPECT_EQ(inflated.sweep(start, {3.6, 1.1, 1.1}), Occupancy::kOccupied);
  EXPECT_EQ(inflated.sweep(start, {1.1, 2.1, 1.1}), Occupancy::kUnknown);
  EXPECT_EQ(inflated.sweep(start, {1.1, 1e9, 1.1}), Occupancy::kUnknown);
}

TEST(InflatedWindow, OddCoordinatesAreUnknownNeverFree) {
  OccupancyMap map{MapParams{}};
  map.markFree({{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}});
  const LocalWindow window(*map.freeze(), {{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}});
  const InflatedWindow inflated(window, {0.4, 0.4, 0.4});
  const Eigen::Vector3d inside(1.0, 1.0, 1.0);
  for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    EXPECT_FALSE(inflated.isFree({odd, 1.0, 1.0}));
    EXPECT_EQ(inflated.boxAt({1.0, odd, 1.0}), Occupancy::kUnknown);
    EXPECT_FALSE(inflated.isSweepFree(inside, {odd, 1.0, 1.0}));
    EXPECT_FALSE(inflated.isSweepFree({1.0, 1.0, odd}, inside));
  }
  EXPECT_TRUE(inflated.isSweepFree(inside, inside));
  EXPECT_THROW(InflatedWindow(window, {0.0, 0.4, 0.4}), Precondition);
}

}  // namespace
}  // namespace spelunk::map
