#include "spelunk/terrain/terrain_map.h"

#include <gtest/gtest.h>

#include "spelunk/common/contract.h"
#include "spelunk/common/params.h"
#include "terrain_worlds.h"

namespace spelunk::terrain {
namespace {

TEST(TerrainMap, ShippedParametersLoad) {
  ParamTree tree;
  tree.addYamlFile(std::string(SPELUNK_SOURCE_DIR) + "/config/terrain.yaml");
  TerrainParams params;
  tree.read("terrain", params);
  EXPECT_NO_THROW(tree.requireClean());
  EXPECT_TRUE(params.problems().empty());
  EXPECT_NO_THROW(TerrainMap{params});
}

TEST(TerrainMap, RefusesParametersThatContradictEachOther) {
  TerrainParams params;
  params.traversability.drop_margin_m = 0.5;
  EXPECT_EQ(params.problems().size(), 1U);
  EXPECT_THROW(TerrainMap{params}, Precondition);
}

TEST(TerrainMap, AFrozenViewStaysWhileTheMapGoesOn) {
  const sim::MeshScene scene(groundWithStep(2.0, 0.1));
  TerrainMap terrain{TerrainParams{}};
  walk(terrain, scene, 0.0, 0.2, Sight::kLidarAndCamera);
  const auto view = terrain.freeze();
  EXPECT_EQ(view, terrain.freeze()) << "nothing changed";
  const int known = view->count(GroundClass::kTraversable);
  walk(terrain, scene, 0.2, 0.6, Sight::kLidarAndCamera);
  EXPECT_EQ(view->count(GroundClass::kTraversable), known);
  EXPECT_GT(terrain.freeze()->count(GroundClass::kTraversable), known);
}

TEST(TerrainMap, TellsTheHeightOfTheGround) {
  const sim::MeshScene scene(groundWithStep(2.0, 0.1));
  TerrainMap terrain{TerrainParams{}};
  walk(terrain, scene, 0.0, 0.5, Sight::kLidarAndCamera);
  EXPECT_NEAR(terrain.groundHeight({1.5, 0.1}).value(), 0.0, 0.02);
  EXPECT_NEAR(terrain.groundHeight({2.5, 0.1}).value(), 0.1, 0.02);
  EXPECT_FALSE(terrain.groundHeight({0.5, 0.0}).has_value()) << "under the body";
  EXPECT_FALSE(terrain.groundHeight({9.0, 0.0}).has_value()) << "out of reach";
}

TEST(TerrainMap, WithoutACameraTheGroundNearTheFeetStaysUnknownAtFirst) {
  const sim::MeshScene scene(groundWithStep(20.0, 0.1));
  TerrainMap terrain{TerrainParams{}};
  terrain.assumeGroundUnder(baseAt(0, 0));
  walk(terrain, scene, 0.0, 0.1, Sight::kLidarOnly);
  const PathGroundCheck near = terrain.checkPath({{{0, 0, 0.5}, 0}, {{1.5, 0, 0.5}, 0}});
  EXPECT_EQ(near.status, PathGround::kUnknown);
  walk(terrain, scene, 0.1, 4.0, Sight::kLidarOnly);
  const PathGroundCheck later = terrain.checkPath({{{4.0, 0, 0.5}, 0}, {{7.0, 0, 0.5}, 0}});
  EXPECT_EQ(later.status, PathGround::kTraversable) << "the rings have passed over it by then";
}

TEST(TerrainMap, NoGroundUnderTheRobotIsUnknownEverywhere) {
  TerrainMap terrain{TerrainParams{}};
  EXPECT_EQ(terrain.checkPath({{{0, 0, 0.5}, 0}}).status, PathGround::kUnknown);
  Scan empty;
  empty.T_world_sensor = baseAt(0, 0);
  EXPECT_EQ(terrain.insert(empty, baseAt(0, 0)).verdict, ScanVerdict::kEmpty);
  EXPECT_EQ(terrain.checkPath({{{0, 0, 0.5}, 0}}).status, PathGround::kUnknown);
  EXPECT_TRUE(terrain.freeze()->points().empty());
}

TEST(TerrainMap, CellsOfTwoCentimetresWorkToo) {
  TerrainParams params;
  params.elevation.cell_m = 0.02;
  params.elevation.reach_m = 2.5;
  const sim::MeshScene scene(groundWithHole(1.8, 0.5, 1.0));
  TerrainMap terrain(params);
  terrain.assumeGroundUnder(baseAt(0, 0));
  walk(terrain, scene, 0.0, 0.3, Sight::kLidarAndCamera);
  const PathGroundCheck check = terrain.checkPath({{{0.3, 0, 0.5}, 0}, {{2.3, 0, 0.5}, 0}});
  EXPECT_EQ(check.status, PathGround::kUntraversable);
  EXPECT_NEAR(check.where.x(), 2.0, 0.3);
}

TEST(TerrainMap, ClearForgetsAll) {
  const sim::MeshScene scene(groundWithStep(2.0, 0.1));
  TerrainMap terrain{TerrainParams{}};
  walk(terrain, scene, 0.0, 0.2, Sight::kLidarAndCamera);
  terrain.clear();
  EXPECT_TRUE(terrain.freeze()->points().empty());
}

}  // namespace
}  // namespace spelunk::terrain
