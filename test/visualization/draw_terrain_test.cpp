#include "spelunk/visualization/draw_terrain.h"

#include <gtest/gtest.h>

#include <limits>

#include "terrain/terrain_worlds.h"

namespace spelunk::visualization {
namespace {

using terrain::GroundClass;
using terrain::TerrainPoint;

TerrainPoint ground(GroundClass ground_class, double value = 0.0) {
  TerrainPoint point;
  point.ground_class = ground_class;
  point.value = value;
  return point;
}

TEST(TerrainColour, GetsRedderAsTheGroundGetsWorse) {
  const Colour best = terrainColour(ground(GroundClass::kTraversable, 1.0));
  const Colour middle = terrainColour(ground(GroundClass::kTraversable, 0.5));
  const Colour worst = terrainColour(ground(GroundClass::kTraversable, 0.0));
  const Colour step = terrainColour(ground(GroundClass::kStep));
  EXPECT_GT(best.g - best.r, middle.g - middle.r);
  EXPECT_GT(middle.g - middle.r, worst.g - worst.r);
  EXPECT_GT(worst.g - worst.r, step.g - step.r);
  EXPECT_GT(step.r, 0.8F);
}

TEST(TerrainColour, TellsDropsUnknownAndUntraversableApart) {
  const Colour drop = terrainColour(ground(GroundClass::kDrop));
  EXPECT_EQ(drop.r + drop.g + drop.b, 0.0F);
  const Colour unknown = terrainColour(ground(GroundClass::kUnknown));
  EXPECT_EQ(unknown.r, unknown.g);
  EXPECT_EQ(unknown.g, unknown.b);
  for (const GroundClass bad : {GroundClass::kTooSteep, GroundClass::kStep, GroundClass::kTooRough})
    EXPECT_EQ(terrainColour(ground(bad)).r, terrainColour(ground(GroundClass::kStep)).r);
}

TEST(DrawTerrain, ShowsEveryCellWithTheColourOfItsClass) {
  const sim::MeshScene scene(terrain::groundWithHole(1.8, 0.8, 2.0));
  terrain::TerrainMap map{terrain::TerrainParams{}};
  walk(map, scene, 0.0, 0.3, terrain::Sight::kLidarAndCamera);
  const auto view = map.freeze();
  ASSERT_GT(view->count(GroundClass::kDrop), 0) << "the world has lost its hole";

  Scene drawn;
  drawTerrain(*view, drawn);
  const auto layer = drawn.layer("terrain");
  ASSERT_EQ(layer.size(), 1U);
  const Element& cells = *layer[0];
  EXPECT_EQ(cells.size_m, view->grid().cell());
  int drops = 0;
  int green = 0;
  ASSERT_EQ(cells.points.size(), cells.colours.size());
  for (std::size_t i = 0; i < cells.points.size(); ++i) {
    const GroundClass shown = view->classAt(view->grid().cellOf(cells.points[i].head<2>()));
    const Colour& colour = cells.colours[i];
    drops += colour.r + colour.g + colour.b == 0.0F ? 1 : 0;
    green += colour.g > colour.r && colour.g > colour.b ? 1 : 0;
    EXPECT_EQ(colour.r + colour.g + colour.b == 0.0F, shown == GroundClass::kDrop);
  }
  EXPECT_EQ(drops, view->count(GroundClass::kDrop));
  EXPECT_GT(green, 1000) << "flat ground all around";
}

TEST(DrawTerrain, NothingIsKnownNothingIsDrawn) {
  terrain::TerrainMap map{terrain::TerrainParams{}};
  Scene scene;
  drawTerrain(*map.freeze(), scene);
  EXPECT_TRUE(scene.elements().empty());
}

TEST(DrawFeet, ContactIsSeenAndBrokenPositionsAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  drawFeet({{{1, 2, 0}, true}, {{nan, 0, 0}, true}, {{1, -2, 0.1}, false}}, scene);
  const auto feet = scene.layer("feet");
  ASSERT_EQ(feet.size(), 1U);
  ASSERT_EQ(feet[0]->points.size(), 2U);
  EXPECT_EQ(feet[0]->points[1].y(), -2.0);
  EXPECT_EQ(feet[0]->colours[0].r, feet[0]->colours[0].b) << "stands";
  EXPECT_GT(feet[0]->colours[1].b, feet[0]->colours[1].r) << "in the air";
}

}  // namespace
}  // namespace spelunk::visualization
