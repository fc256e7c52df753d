#include "spelunk/map/frozen_map.h"

#include <gtest/gtest.h>

#include <tuple>

#include "map_worlds.h"
#include "spelunk/common/contract.h"
#include "spelunk/map/local_window.h"

namespace spelunk::map {
namespace {

std::vector<Occupancy> statuses(const FrozenMap& map) {
  std::vector<Occupancy> all;
  for (int z = -8; z < 18; ++z)
    for (int y = -24; y < 28; ++y)
      for (int x = -48; x < 58; ++x) all.push_back(map.at(VoxelIndex(x, y, z)));
  return all;
}

TEST(FrozenMap, DoesNotChangeWhileScansArrive) {
  Rng rng(1);
  OccupancyMap map{MapParams{}};
  std::vector<std::shared_ptr<const FrozenMap>> views;
  std::vector<std::vector<Occupancy>> wanted;
  for (int i = 0; i < 8; ++i) {
    map.insert(hallScan(rng, hallPosition(2 * i), 400), noBody());
    views.push_back(map.freeze());
    wanted.push_back(statuses(*views.back()));
  }
  EXPECT_NE(wanted.front(), wanted.back());
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(statuses(*views[i]), wanted[i]) << i;
}

TEST(FrozenMap, OutlivesItsMap) {
  std::shared_ptr<const FrozenMap> view;
  {
    OccupancyMap map = hallMap(MapParams{}, 2, 300, 4);
    view = map.freeze();
  }
  EXPECT_GT(view->freeVoxels(), 100u);
  EXPECT_EQ(view->at(hallPosition(0)), Occupancy::kFree);
}

TEST(FrozenMap, UnchangedMapGivesTheSameView) {
  OccupancyMap map = hallMap(MapParams{}, 2, 300, 4);
  EXPECT_EQ(map.freeze(), map.freeze());
}

TEST(FrozenMap, CountsAndBoundsAreThoseOfTheVoxels) {
  OccupancyMap map = hallMap(MapParams{}, 6, 500, 9);
  const auto view = map.freeze();
  std::size_t free = 0;
  std::size_t occupied = 0;
  VoxelIndex low = VoxelIndex::Constant(1000);
  VoxelIndex high = VoxelIndex::Constant(-1000);
  for (int x = -80; x < 90; ++x)
    for (int y = -60; y < 60; ++y)
      for (int z = -30; z < 40; ++z) {
        const Occupancy status = view->at(VoxelIndex(x, y, z));
        free += status == Occupancy::kFree ? 1 : 0;
        occupied += status == Occupancy::kOccupied ? 1 : 0;
        if (status == Occupancy::kUnknown) continue;
        low = low.cwiseMin(VoxelIndex(x, y, z));
        high = high.cwiseMax(VoxelIndex(x, y, z));
      }
  EXPECT_EQ(view->freeVoxels(), free);
  EXPECT_EQ(view->occupiedVoxels(), occupied);
  EXPECT_TRUE(view->knownBounds().min.isApprox(low.cast<double>() * 0.2, 1e-12));
  EXPECT_TRUE(view->knownBounds().max.isApprox((high.array() + 1).cast<double>().matrix() * 0.2));
}

TEST(FrozenMap, VisitsOccupiedVoxelsOfARegionOnceInAFixedOrder) {
  OccupancyMap map = hallMap(MapParams{}, 6, 800, 9);
  const auto view = map.freeze();
  const AxisAlignedBox region{{-9.5, -4.1, -1.0}, {2.3, 2.0, 2.0}};
  std::vector<VoxelIndex> visited;
  view->forEachOccupied(region, [&](const VoxelIndex& index) { visited.push_back(index); });
  std::size_t wanted = 0;
  for (int x = -80; x < 90; ++x)
    for (int y = -60; y < 60; ++y)
      for (int z = -30; z < 40; ++z)
        wanted += view->at(VoxelIndex(x, y, z)) == Occupancy::kOccupied &&
                          region.contains(view->centreOf({x, y, z}))
                      ? 1
                      : 0;
  EXPECT_GT(wanted, 300u);
  EXPECT_EQ(visited.size(), wanted);
  for (const VoxelIndex& index : visited) {
    EXPECT_EQ(view->at(index), Occupancy::kOccupied);
    EXPECT_TRUE(region.contains(view->centreOf(index)));
  }
  // The same map reached by other snapshots visits in the same order.
  Rng rng(9);
  OccupancyMap other{MapParams{}};
  for (int i = 0; i < 6; ++i) {
    other.insert(hallScan(rng, hallPosition(i), 800), noBody());
    EXPECT_NE(other.freeze(), nullptr);
  }
  std::vector<VoxelIndex> again;
  other.freeze()->forEachOccupied(region, [&](const VoxelIndex& v) { again.push_back(v); });
  EXPECT_EQ(visited, again);
}

TEST(FrozenMap, EmptyMapIsUnknownEverywhere) {
  OccupancyMap map{MapParams{}};
  const auto view = map.freeze();
  EXPECT_TRUE(view->knownBounds().isEmpty());
  EXPECT_EQ(view->at(VoxelIndex(0, 0, 0)), Occupancy::kUnknown);
  EXPECT_EQ(view->at(VoxelIndex(1 << 30, 0, -(1 << 30))), Occupancy::kUnknown);
  view->forEachOccupied(AxisAlignedBox{}, [](const VoxelIndex&) { ADD_FAILURE(); });
}

TEST(LocalWindow, EqualsTheMapVoxelByVoxel) {
  OccupancyMap map = hallMap(MapParams{}, 6, 800, 5);
  const auto view = map.freeze();
  Rng rng(3);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d corner(rng.uniform(-12, 8), rng.uniform(-6, 4), rng.uniform(-2, 2));
    const Eigen::Vector3d size(rng.uniform(0, 12), rng.uniform(0, 7), rng.uniform(0, 4));
    const LocalWindow window(*view, {corner, corner + size});
    EXPECT_TRUE((window.region().min.array() <= corner.array() + 1e-9).all());
    EXPECT_TRUE((window.region().max.array() >= (corner + size).array() - 1e-9).all());
    for (int z = -2; z < window.size().z() + 2; ++z)
      for (int y = -2; y < window.size().y() + 2; ++y)
        for (int x = -2; x < window.size().x() + 2; ++x) {
          const VoxelIndex local(x, y, z);
          const VoxelIndex index = window.origin() + local;
          const bool is_inside =
              (local.array() >= 0).all() && (local.array() < window.size().array()).all();
          ASSERT_EQ(window.at(index), is_inside ? view->at(index) : Occupancy::kUnknown);
        }
  }
}

TEST(LocalWindow, RefusesRegionsItCannotHold) {
  OccupancyMap map{MapParams{}};
  const auto view = map.freeze();
  EXPECT_THROW(LocalWindow(*view, AxisAlignedBox{}), Precondition);
  EXPECT_THROW(LocalWindow(*view, noBody()), Precondition);
  EXPECT_THROW(LocalWindow(*view, boxAround({0, 0, 0}, {900, 900, 900})), Precondition);
  EXPECT_THROW(LocalWindow(*view, boxAround({0, 0, 0}, {1e300, 1, 1})), Precondition);
}

}  // namespace
}  // namespace spelunk::map
