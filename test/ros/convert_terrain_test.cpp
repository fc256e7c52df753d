#include "spelunk/ros/convert_terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "spelunk/ros/cloud_filter.h"
#include "terrain/terrain_worlds.h"

namespace spelunk::bridge {
namespace {

using terrain::CellIndex;
using terrain::GroundClass;

/// Ground with a hole whose edge is steep, with drops and cells never seen, as the robot comes up.
std::shared_ptr<const terrain::TerrainView> viewOfHole() {
  const sim::MeshScene scene(terrain::groundWithHole(1.8, 0.8, 2.0));
  terrain::TerrainMap map{terrain::TerrainParams{}};
  walk(map, scene, 0.0, 0.3, terrain::Sight::kLidarAndCamera);
  return map.freeze();
}

int valueIn(const nav_msgs::OccupancyGrid& grid, const Eigen::Vector2d& xy) {
  const int x = static_cast<int>((xy.x() - grid.info.origin.position.x) / grid.info.resolution);
  const int y = static_cast<int>((xy.y() - grid.info.origin.position.y) / grid.info.resolution);
  return grid.data[static_cast<std::size_t>(y) * grid.info.width + static_cast<std::size_t>(x)];
}

TEST(TraversabilityMsg, EveryCellLiesWhereTheViewHasIt) {
  const auto view = viewOfHole();
  const auto grid = traversabilityMsg(*view, "world", ros::Time(3.0));
  EXPECT_EQ(grid.header.frame_id, "world");
  EXPECT_NEAR(grid.info.resolution, 0.04, 1e-6);
  ASSERT_GT(grid.info.width, 100U);
  ASSERT_EQ(grid.data.size(), std::size_t{grid.info.width} * grid.info.height);
  std::map<GroundClass, int> seen;
  const CellIndex last = view->grid().first().array() + view->grid().side();
  for (int y = view->grid().first().y(); y < last.y(); ++y)
    for (int x = view->grid().first().x(); x < last.x(); ++x) {
      const CellIndex cell(x, y);
      if (!view->covers(cell)) continue;
      const GroundClass ground = view->classAt(cell);
      const int value = valueIn(grid, view->grid().centreOf(cell));
      ++seen[ground];
      if (ground == GroundClass::kUnknown) {
        ASSERT_EQ(value, -1);
      } else if (ground == GroundClass::kTraversable) {
        ASSERT_NEAR(value, 98.0 * (1.0 - view->valueAt(cell).value()), 0.51);
      } else {
        ASSERT_EQ(value, 100);
      }
    }
  for (const GroundClass ground :
       {GroundClass::kUnknown, GroundClass::kTraversable, GroundClass::kDrop})
    EXPECT_GT(seen[ground], 10) << "the view lacks what the test is about";
}

TEST(TraversabilityMsg, LiesAtTheHeightOfTheGround) {
  const sim::MeshScene scene(terrain::groundWithStep(-5.0, 2.5));
  terrain::TerrainMap map{terrain::TerrainParams{}};
  walk(map, scene, 0.0, 0.1, terrain::Sight::kLidarAndCamera, [](double) { return 2.5; });
  EXPECT_NEAR(traversabilityMsg(*map.freeze(), "world", {}).info.origin.position.z, 2.5, 0.03);
}

TEST(TraversabilityMsg, OfAnEmptyMapIsUnknownAndFinite) {
  terrain::TerrainMap map{terrain::TerrainParams{}};
  const auto grid = traversabilityMsg(*map.freeze(), "world", {});
  EXPECT_EQ(grid.info.origin.position.z, 0.0);
  for (const std::int8_t value : grid.data) ASSERT_EQ(value, -1);
}

/// The float32 field `name` of point `index`.
float fieldOf(const sensor_msgs::PointCloud2& cloud, const std::string& name, std::size_t index) {
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    float value = 0.0F;
    std::memcpy(&value, &cloud.data[index * cloud.point_step + field.offset], sizeof(value));
    return value;
  }
  ADD_FAILURE() << "no field " << name;
  return 0.0F;
}

std::uint32_t rgbOf(const sensor_msgs::PointCloud2& cloud, std::size_t index) {
  const float packed = fieldOf(cloud, "rgb", index);
  std::uint32_t rgb = 0;
  std::memcpy(&rgb, &packed, sizeof(rgb));
  return rgb;
}

TEST(ElevationMsg, HasEveryPointOfTheViewInItsColour) {
  const auto view = viewOfHole();
  const auto points = view->points();
  const auto cloud = elevationMsg(*view, "world", ros::Time(3.0));
  ASSERT_EQ(cloud.width, points.size());
  ASSERT_EQ(cloud.data.size(), std::size_t{cloud.width} * cloud.point_step);
  int drops = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(fieldOf(cloud, "x", i), static_cast<float>(points[i].position.x()));
    ASSERT_EQ(fieldOf(cloud, "z", i), static_cast<float>(points[i].position.z()));
    ASSERT_EQ(fieldOf(cloud, "variance_m2", i), static_cast<float>(points[i].variance_m2));
    const bool is_unknown = points[i].ground_class == GroundClass::kUnknown;
    ASSERT_EQ(std::isnan(fieldOf(cloud, "traversability", i)), is_unknown);
    const bool is_drop = points[i].ground_class == GroundClass::kDrop;
    ASSERT_EQ(rgbOf(cloud, i) == 0U, is_drop);
    drops += is_drop ? 1 : 0;
  }
  EXPECT_GT(drops, 10);
  const auto read = pointsFromMsg(cloud);
  ASSERT_TRUE(read.value) << read.problem;
  EXPECT_EQ(read.value->size(), points.size());
}

TEST(ElevationMsg, PacksRedIntoTheThirdByte) {
  const sim::MeshScene scene(terrain::groundWithStep(1.5, 0.6));
  terrain::TerrainMap map{terrain::TerrainParams{}};
  walk(map, scene, 0.0, 0.1, terrain::Sight::kLidarAndCamera);
  const auto view = map.freeze();
  const auto points = view->points();
  const auto cloud = elevationMsg(*view, "world", {});
  int steps = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].ground_class != GroundClass::kStep) continue;
    ++steps;
    EXPECT_GT(rgbOf(cloud, i) >> 16U, 200U);
    EXPECT_LT(rgbOf(cloud, i) & 0xFFU, 50U);
  }
  EXPECT_GT(steps, 10);
}

TEST(ElevationMsg, OfAnEmptyMapHasNoPoints) {
  terrain::TerrainMap map{terrain::TerrainParams{}};
  const auto cloud = elevationMsg(*map.freeze(), "world", {});
  EXPECT_EQ(cloud.width, 0U);
  EXPECT_TRUE(cloud.data.empty());
}

}  // namespace
}  // namespace spelunk::bridge
