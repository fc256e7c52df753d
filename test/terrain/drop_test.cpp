#include <gtest/gtest.h>

#include "terrain_worlds.h"

namespace spelunk::terrain {
namespace {

/// Three metres straight ahead of a robot that stands at x.
Path ahead(double x, double z = kBaseHeight_m) {
  return {{{x, 0.0, z}, 0.0}, {{x + 3.0, 0.0, z}, 0.0}};
}

/// The map of a robot that started at `from_m` and walked to `to_m` on flat ground.
TerrainMap walked(const sim::WorldMesh& mesh, double from_m, double to_m, Sight sight) {
  const sim::MeshScene scene(mesh);
  TerrainMap terrain{TerrainParams{}};
  terrain.assumeGroundUnder(baseAt(from_m, 0.0));
  walk(terrain, scene, from_m, to_m, sight);
  return terrain;
}

int dropsIn(const TerrainView& view, double x0, double x1, double y0, double y1) {
  int drops = 0;
  const CellIndex last = view.grid().cellOf({x1, y1});
  for (CellIndex cell = view.grid().cellOf({x0, y0}); cell.y() <= last.y(); ++cell.y())
    for (cell.x() = view.grid().cellOf({x0, 0.0}).x(); cell.x() <= last.x(); ++cell.x())
      drops += view.classAt(cell) == GroundClass::kDrop ? 1 : 0;
  return drops;
}

TEST(Drop, HoleOfHalfAMetreIsFoundMoreThanAMetreAhead) {
  for (const double depth : {0.5, 1.0, 3.0}) {
    // The body's front is at 0.6 m, so the hole's edge is 1.9 m from it.
    TerrainMap terrain = walked(groundWithHole(2.5, 0.5, depth), -0.5, 0.0, Sight::kLidarAndCamera);
    const PathGroundCheck check = terrain.checkPath(ahead(0.0));
    ASSERT_EQ(check.status, PathGround::kUntraversable)
        << "depth " << depth << "\n"
        << pictureOf(*terrain.freeze(), -1, 4, -1, 1, 0.08);
    EXPECT_EQ(check.reason, GroundClass::kDrop);
    EXPECT_NEAR(check.where.x(), 2.75, 0.25);
    EXPECT_NEAR(check.where.y(), 0.0, 0.1);
    EXPECT_LT(check.arc_m, 3.0 - 0.6) << "the front must not stand on the far edge";
  }
}

TEST(Drop, NearTheHoleMostOfItIsMarkedAndNothingElse) {
  TerrainMap terrain = walked(groundWithHole(2.5, 0.5, 1.0), 0.0, 1.5, Sight::kLidarAndCamera);
  const auto view = terrain.freeze();
  EXPECT_GT(dropsIn(*view, 2.5, 3.0, -0.25, 0.25), 100) << "of 144 cells";
  EXPECT_EQ(dropsIn(*view, 2.4, 3.1, -0.35, 0.35), view->count(GroundClass::kDrop));
}

TEST(Drop, HoleIsFoundWithoutACameraWhenTheRingsPassOverIt) {
  TerrainMap terrain = walked(groundWithHole(2.5, 0.5, 1.0), -0.5, 1.0, Sight::kLidarOnly);
  EXPECT_GT(dropsIn(*terrain.freeze(), 2.5, 3.0, -0.25, 0.25), 10);
}

TEST(Drop, WideShaftIsFoundBeforeTheFeetReachIt) {
  TerrainMap terrain = walked(groundWithHole(2.5, 4.0, 6.0), 0.0, 1.0, Sight::kLidarAndCamera);
  const PathGroundCheck check = terrain.checkPath(ahead(1.0));
  EXPECT_NE(check.status, PathGround::kTraversable);
  EXPECT_LT(check.arc_m + 0.6, 2.5 - 1.0 + 0.6) << "refused before the middle is over the edge";
}

TEST(Drop, FlatGroundHasNone) {
  sim::WorldMesh mesh;
  addSlab(mesh, -10, 20, -10, 10, 0.0);
  for (const Sight sight : {Sight::kLidarOnly, Sight::kLidarAndCamera}) {
    TerrainMap terrain = walked(mesh, 0.0, 1.0, sight);
    EXPECT_EQ(terrain.freeze()->count(GroundClass::kDrop), 0);
    EXPECT_EQ(terrain.freeze()->count(GroundClass::kTooSteep), 0);
    EXPECT_GT(terrain.freeze()->count(GroundClass::kTraversable), 8000);
  }
}

TEST(Drop, StepsDownThatCanBeTakenAreNone) {
  for (const double start : {0.0, 0.5, 1.0, 1.5}) {
    TerrainMap terrain = walked(groundWithStep(2.5, -0.15), 0.0, start, Sight::kLidarAndCamera);
    const auto view = terrain.freeze();
    EXPECT_EQ(dropsIn(*view, 0.0, 4.0, -0.5, 0.5), 0) << pictureOf(*view, -1, 4, -1, 1, 0.08);
  }
  TerrainMap terrain = walked(groundWithStep(2.5, -0.15), 0.0, 1.5, Sight::kLidarAndCamera);
  EXPECT_EQ(terrain.checkPath({{{1.5, 0, 0.5}, 0}, {{3.0, 0, 0.35}, 0}}).status,
            PathGround::kTraversable);
}

TEST(Drop, StepsUpThatAreTooHighAreRefused) {
  TerrainMap terrain = walked(groundWithStep(2.5, 0.4), 0.0, 1.0, Sight::kLidarAndCamera);
  const PathGroundCheck check = terrain.checkPath(ahead(1.0));
  EXPECT_EQ(check.status, PathGround::kUntraversable);
  EXPECT_NEAR(check.where.x(), 2.5, 0.4);
}

TEST(Drop, StepsDownThatAreTooHighAreRefusedAndFromNearByKnownToBeBad) {
  TerrainMap far = walked(groundWithStep(2.5, -0.4), 0.0, 1.0, Sight::kLidarAndCamera);
  EXPECT_NE(far.checkPath(ahead(1.0)).status, PathGround::kTraversable);
  TerrainMap near = walked(groundWithStep(2.5, -0.4), 0.0, 1.7, Sight::kLidarAndCamera);
  const PathGroundCheck check = near.checkPath(ahead(1.7));
  EXPECT_EQ(check.status, PathGround::kUntraversable)
      << pictureOf(*near.freeze(), -1, 5, -1, 1, 0.08);
  EXPECT_NEAR(check.where.x(), 2.7, 0.3);
}

TEST(Drop, RampsOfTwentyDegreesAreWalkableUpAndDown) {
  for (const double angle : {-20.0, 20.0}) {
    const sim::WorldMesh mesh = groundWithRamp(2.0, angle * M_PI / 180.0, 6.0);
    TerrainMap terrain = walked(mesh, 0.0, 1.3, Sight::kLidarAndCamera);
    const auto view = terrain.freeze();
    EXPECT_EQ(dropsIn(*view, 0.0, 4.5, -1.0, 1.0), 0) << pictureOf(*view, -1, 5, -1, 1, 0.08);
    const double fall = std::tan(angle * M_PI / 180.0);
    EXPECT_EQ(terrain.checkPath({{{1.3, 0, 0.5}, 0}, {{3.5, 0, 0.5 + 1.5 * fall}, 0}}).status,
              PathGround::kTraversable)
        << angle;
  }
}

TEST(Drop, SlopesOfFortyFiveDegreesAreRefused) {
  TerrainMap terrain =
      walked(groundWithRamp(2.5, M_PI / 4.0, 3.0), 0.0, 1.0, Sight::kLidarAndCamera);
  const PathGroundCheck check = terrain.checkPath(ahead(1.0));
  EXPECT_EQ(check.status, PathGround::kUntraversable);
  EXPECT_EQ(check.reason, GroundClass::kTooSteep);
}

TEST(Drop, BehindARockIsUnknownAndNoDrop) {
  sim::WorldMesh mesh;
  addSlab(mesh, -10, 20, -10, 10, 0.0);
  test::addBox(mesh, {2.0F, -0.2F, -0.1F}, {2.4F, 0.2F, 0.4F});
  TerrainMap terrain = walked(mesh, -0.5, 0.5, Sight::kLidarAndCamera);
  const auto view = terrain.freeze();
  // A ray that passes close beside the rock may lie below what its top lets expect: single cells.
  EXPECT_LE(view->count(GroundClass::kDrop), 3) << pictureOf(*view, -1, 4, -1, 1, 0.08);
  EXPECT_EQ(view->classAt(view->grid().cellOf({2.7, 0.0})), GroundClass::kUnknown);
  EXPECT_EQ(terrain.checkPath(ahead(0.5)).status, PathGround::kUntraversable);
}

}  // namespace
}  // namespace spelunk::terrain
