#include "spelunk/map/frozen_map.h"

#include <gtest/gtest.h>

#include <tuple>

#include "map_worlds.h"
#include "spelunk/common/contract.h"
#include "spelunk/map/kept_window.h"

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

/// Whether two windows say the same of every voxel around `region`.
void expectSame(const LocalWindow& some, const LocalWindow& other, const AxisAlignedBox& region) {
  const VoxelIndex first = some.indexOf(region.min);
  const VoxelIndex last = some.indexOf(region.max);
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        ASSERT_EQ(some.at(VoxelIndex(x, y, z)), other.at(VoxelIndex(x, y, z)))
            << x << " " << y << " " << z;
}

TEST(LocalWindow, BroughtUpToDateIsThatOfTheNewMap) {
  OccupancyMap map = hallMap(MapParams{}, 4, 300, 5);
  const AxisAlignedBox region{{-9.3, -5.1, -1.7}, {8.2, 4.9, 2.6}};
  auto before = map.freeze();
  LocalWindow window(*before, region);
  Rng rng(11);
  for (int i = 0; i < 6; ++i) {
    Scan scan;
    scan.T_world_sensor = Eigen::Translation3d(rng.uniform(-8, 8), rng.uniform(-4, 4), 0.0) *
                          Eigen::Quaterniond::Identity();
    for (int k = 0; k < 200; ++k)  // through what was occupied and into what was free
      scan.points.emplace_back(static_cast<float>(rng.uniform(-6, 6)),
                               static_cast<float>(rng.uniform(-6, 6)),
                               static_cast<float>(rng.uniform(-2, 2)));
    map.insert(scan, noBody());
    const auto now = map.freeze();
    window.update(*before, *now);
    const LocalWindow anew(*now, region);
    expectSame(window, anew, region);
    EXPECT_TRUE((window.knownFirst().array() <= anew.knownFirst().array()).all());
    EXPECT_TRUE((window.knownLast().array() >= anew.knownLast().array()).all());
    before = now;
  }
}

TEST(LocalWindow, OfAnotherMapIsCopiedAnew) {
  OccupancyMap map = hallMap(MapParams{}, 4, 300, 5);
  const auto before = map.freeze();
  const AxisAlignedBox region{{-9.3, -5.1, -1.7}, {8.2, 4.9, 2.6}};
  LocalWindow window(*before, region);
  OccupancyMap other = hallMap(MapParams{}, 1, 50, 9);
  window.update(*before, *other.freeze());
  expectSame(window, LocalWindow(*other.freeze(), region), region);
}

TEST(KeptWindow, FollowsAMovingRegionThroughAChangingMap) {
  OccupancyMap map = hallMap(MapParams{}, 2, 300, 5);
  KeptWindow kept({2.0, 1.0, 0.5});
  int copied_anew = 0;
  VoxelIndex origin = VoxelIndex::Zero();
  for (int i = 0; i < 20; ++i) {
    const double x = -8.0 + 0.7 * i;
    map.markFree(boxAround({x, 0.3 * i - 3.0, 0.0}, {1.0, 1.0, 2.0}));
    const auto now = map.freeze();
    const AxisAlignedBox region{{x - 3.0, -4.0, -1.2}, {x + 3.0, 4.0, 1.4}};
    const LocalWindow& window = kept.over(now, region);
    copied_anew += window.origin() != origin ? 1 : 0;
    origin = window.origin();
    EXPECT_TRUE((window.region().min.array() <= region.min.array()).all());
    EXPECT_TRUE((window.region().max.array() >= region.max.array()).all());
    expectSame(window, LocalWindow(*now, region), region);
  }
  EXPECT_GE(copied_anew, 3);
  EXPECT_LE(copied_anew, 10);
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
