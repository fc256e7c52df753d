#include "spelunk/map/free_voxels.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "map_worlds.h"

namespace spelunk::map {
namespace {

MapParams coarse() {
  MapParams params;
  params.resolution_m = 0.5;
  return params;
}

const AxisAlignedBox kLeft{{-40.0, 0.0, 0.0}, {-38.0, 1.0, 1.0}};
const AxisAlignedBox kRight{{20.0, 3.0, -2.0}, {21.0, 5.0, -1.0}};

std::shared_ptr<const FrozenMap> twoPlaces(bool left_first) {
  OccupancyMap map(coarse());
  for (const bool left : {left_first, !left_first}) {
    AxisAlignedBox box = left ? kLeft : kRight;
    box.min.array() += 0.01;  // the touched voxels are those inside
    box.max.array() -= 0.01;
    map.markFree(box);
  }
  return map.freeze();
}

TEST(FreeVoxels, DrawsEveryFreeVoxelAboutEquallyOftenAndNoOther) {
  const auto map = twoPlaces(true);
  ASSERT_EQ(map->freeVoxels(), 32U);
  const FreeVoxels voxels(map, AxisAlignedBox{});
  Rng rng(4);
  std::map<std::tuple<int, int, int>, int> hits;
  constexpr int kDraws = 32 * 400;
  for (int k = 0; k < kDraws; ++k) {
    const auto point = voxels.draw(rng);
    ASSERT_TRUE(point.has_value());
    ASSERT_EQ(map->at(*point), Occupancy::kFree);
    const VoxelIndex index = map->indexOf(*point);
    ++hits[{index.x(), index.y(), index.z()}];
  }
  EXPECT_EQ(hits.size(), 32U);
  for (const auto& [index, count] : hits) EXPECT_NEAR(count, 400, 120);  // 6 standard deviations
}

TEST(FreeVoxels, LeavesOutOccupiedVoxelsAndWhatLiesOutsideTheRegion) {
  OccupancyMap map(coarse());
  map.markFree({{0.01, 0.01, 0.01}, {7.99, 0.49, 0.49}});
  Scan hit;
  hit.T_world_sensor.translation() = Eigen::Vector3d(1.25, 0.25, 0.25);
  hit.points.emplace_back(1.0F, 0.0F, 0.0F);  // x = 2.25
  for (int k = 0; k < 5; ++k) map.insert(hit, {Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero()});
  const auto frozen = map.freeze();
  ASSERT_EQ(frozen->at(Eigen::Vector3d(2.25, 0.25, 0.25)), Occupancy::kOccupied);
  const FreeVoxels voxels(frozen, {{1.0, -1.0, -1.0}, {4.0, 1.0, 1.0}});
  Rng rng(9);
  std::map<int, int> columns;
  for (int k = 0; k < 2000; ++k) ++columns[frozen->indexOf(*voxels.draw(rng)).x()];
  EXPECT_EQ(columns.size(), 5U) << "x = 1..4 has six voxels, one of them occupied";
  EXPECT_EQ(columns.count(4), 0U);
  EXPECT_EQ(columns.begin()->first, 2);
  EXPECT_EQ(columns.rbegin()->first, 7);
}

TEST(FreeVoxels, DoesNotDependOnTheOrderInWhichPlacesWereSeen) {
  const FreeVoxels first(twoPlaces(true), AxisAlignedBox{});
  const FreeVoxels second(twoPlaces(false), AxisAlignedBox{});
  Rng a(5);
  Rng b(5);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(*first.draw(a), *second.draw(b));
}

TEST(FreeVoxels, NothingFreeGivesNothing) {
  Rng rng(1);
  const FreeVoxels nowhere(twoPlaces(true), {{0.0, 0.0, 0.0}, {5.0, 5.0, 5.0}});
  EXPECT_FALSE(nowhere.draw(rng).has_value());
  const FreeVoxels empty(OccupancyMap(coarse()).freeze(), AxisAlignedBox{});
  EXPECT_FALSE(empty.draw(rng).has_value());
}

}  // namespace
}  // namespace spelunk::map
