#include "spelunk/evaluation/plan_view.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "spelunk/common/contract.h"
#include "spelunk/map/occupancy_map.h"
#include "support/temporary_folder.h"

namespace spelunk::evaluation {
namespace {

/// Free from (0, 0, 0.4) to (8, 4, 2) with one wall voxel seen at (5.1, 2.1, 1.1).
map::OccupancyMap smallMap() {
  map::OccupancyMap map{map::MapParams{}};
  Scan scan;
  scan.T_world_sensor.translation() = Eigen::Vector3d(1.1, 2.1, 1.1);
  scan.points = {{4.0F, 0.0F, 0.0F}};
  map.insert(scan, AxisAlignedBox{{90, 90, 90}, {91, 91, 91}});
  map.markFree({{0.01, 0.01, 0.41}, {7.99, 3.99, 1.99}});
  return map;
}

std::size_t cellAt(const PlanView& view, double x, double y) {
  const auto column = static_cast<std::size_t>((x - view.origin_m.x()) / view.resolution_m);
  const auto row = static_cast<std::size_t>((y - view.origin_m.y()) / view.resolution_m);
  return row * static_cast<std::size_t>(view.width) + column;
}

TEST(PlanView, CountsTheVoxelsOfEachColumn) {
  map::OccupancyMap map = smallMap();
  const PlanView view = planViewOf(*map.freeze());
  EXPECT_EQ(view.width, 40);
  EXPECT_EQ(view.height, 20);
  EXPECT_NEAR(view.origin_m.x(), 0.0, 1e-9);
  EXPECT_NEAR(view.z_min_m, 0.4, 1e-9);
  EXPECT_EQ(view.free[cellAt(view, 7.1, 3.1)], 8);
  EXPECT_EQ(view.occupied[cellAt(view, 7.1, 3.1)], 0);
  EXPECT_EQ(view.floor[cellAt(view, 7.1, 3.1)], 0);
  EXPECT_EQ(view.free[cellAt(view, 5.1, 2.1)], 7);
  EXPECT_EQ(view.occupied[cellAt(view, 5.1, 2.1)], 1);
}

TEST(PlanView, AgreesWithTheMapVoxelByVoxel) {
  map::OccupancyMap map = smallMap();
  const auto frozen = map.freeze();
  const PlanView view = planViewOf(*frozen);
  std::size_t free = 0;
  std::size_t occupied = 0;
  for (std::size_t i = 0; i < view.free.size(); ++i) {
    free += view.free[i];
    occupied += view.occupied[i];
  }
  EXPECT_EQ(free, frozen->freeVoxels());
  EXPECT_EQ(occupied, frozen->occupiedVoxels());
}

TEST(PlanView, OfAnEmptyMapIsEmpty) {
  map::OccupancyMap map{map::MapParams{}};
  const PlanView view = planViewOf(*map.freeze());
  EXPECT_EQ(view.width, 0);
  EXPECT_TRUE(view.free.empty());
}

TEST(PlanView, IsWrittenAsALineAndThreeLayers) {
  const test::TemporaryFolder folder;
  map::OccupancyMap map = smallMap();
  writePlanView(*map.freeze(), LocalFrame(), folder.at("view"));
  std::ifstream file(folder.at("view"), std::ios::binary);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line.substr(0, 18), "plan_view 1 40 20 ");
  const std::string rest{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(rest.size(), 3U * 40U * 20U);
}

TEST(PlanView, NamesAFileItCannotWrite) {
  map::OccupancyMap map = smallMap();
  EXPECT_THROW(writePlanView(*map.freeze(), LocalFrame(), "/no/such/folder/view"), OutsideError);
}

}  // namespace
}  // namespace spelunk::evaluation
