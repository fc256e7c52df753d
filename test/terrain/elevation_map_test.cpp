#include "spelunk/terrain/elevation_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <tuple>

#include "evaluation/benchmark/plain_elevation.h"
#include "terrain_worlds.h"

namespace spelunk::terrain {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// No body, so that every point counts; sensor in the base.
ElevationParams plainParams() {
  ElevationParams params;
  params.body_m.setZero();
  return params;
}

/// A scan of world points from a sensor in the base.
Scan scanOfPoints(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& base,
                  double stamp_s) {
  Scan scan;
  scan.stamp_s = stamp_s;
  scan.T_world_sensor = base;
  for (const Eigen::Vector3d& point : points)
    scan.points.push_back((base.inverse() * point).cast<float>());
  return scan;
}

/// Hilly ground, walls and things in the air around a robot, a little away from cell borders.
std::vector<Eigen::Vector3d> hillyPoints(Rng& rng, const Eigen::Vector3d& base, double cell_m) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 6000; ++i) {
    Eigen::Vector3d point = base + Eigen::Vector3d(rng.uniform(-3, 3), rng.uniform(-3, 3), 0.0);
    for (int axis = 0; axis < 2; ++axis)
      point(axis) = (std::floor(point(axis) / cell_m) + rng.uniform(0.1, 0.9)) * cell_m;
    point.z() = 0.3 * std::sin(point.x()) + 0.01 * rng.normal();
    if (std::fabs(point.y()) > 2.0) point.z() += rng.uniform(0.0, 1.5);
    if (rng.uniform() < 0.02) point.z() += rng.uniform(-1.0, 3.0);
    points.push_back(point);
  }
  return points;
}

TEST(ElevationMap, FusesAsThePlainFilterDoes) {
  ElevationParams params = plainParams();
  ElevationMap map(params);
  benchmark::PlainElevation plain(params);
  Rng rng(5);
  int compared = 0;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Isometry3d base = baseAt(0.02 * i, 0.0, 0.3 * i);
    const auto points = hillyPoints(rng, base.translation(), params.cell_m);
    const Scan scan = scanOfPoints(points, base, 0.1 * i);
    map.insert(scan, base);
    plain.insert(scan, base);
  }
  for (const auto& [key, cell] : plain.cells()) {
    const auto ours = map.at({key.first, key.second});
    ASSERT_TRUE(ours.has_value());
    EXPECT_NEAR(ours->height_m, cell.height, 1e-4);
    EXPECT_NEAR(ours->variance_m2, cell.variance, 1e-3 * cell.variance + 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 20000);
}

TEST(ElevationMap, RepeatedMeasurementsNarrowTheBounds) {
  ElevationMap map(plainParams());
  const Eigen::Isometry3d base = baseAt(0, 0);
  const CellIndex cell = map.grid().cellOf({1.01, 0.01});
  map.insert(scanOfPoints({{1.01, 0.01, 0.10}}, base, 0.0), base);
  const double first = *map.upperBound(cell, 2.0) - *map.lowerBound(cell, 2.0);
  for (int i = 1; i < 10; ++i) map.insert(scanOfPoints({{1.01, 0.01, 0.10}}, base, 0.1 * i), base);
  const double tenth = *map.upperBound(cell, 2.0) - *map.lowerBound(cell, 2.0);
  EXPECT_LT(tenth, 0.4 * first);
  EXPECT_NEAR(map.at(cell)->height_m, 0.10, 1e-5);
  EXPECT_NEAR(map.at(cell)->stamp_s, 0.9, 1e-5);
}

TEST(ElevationMap, UncertaintyGrowsWithTheWayAndNotWhenStanding) {
  ElevationMap map(plainParams());
  const CellIndex cell = map.grid().cellOf({0.5, 0.0});
  map.insert(scanOfPoints({{0.5, 0.01, 0.0}}, baseAt(0, 0), 0.0), baseAt(0, 0));
  const double before = map.at(cell)->variance_m2;
  map.insert(scanOfPoints({}, baseAt(0, 0), 10.0), baseAt(0, 0));
  EXPECT_EQ(map.at(cell)->variance_m2, before);
  map.insert(scanOfPoints({}, baseAt(2.0, 0), 14.0), baseAt(2.0, 0));
  EXPECT_NEAR(map.at(cell)->variance_m2 - before, 2.0 * 1e-4 + 4.0 * 1e-5, 1e-7);
}

TEST(ElevationMap, AnOutlierIsIgnoredAndAChangedCellReplaced) {
  ElevationMap map(plainParams());
  const Eigen::Isometry3d base = baseAt(0, 0);
  const CellIndex cell = map.grid().cellOf({1.01, 0.01});
  double stamp = 0.0;
  const auto see = [&](double z) {
    return map.insert(scanOfPoints({{1.01, 0.01, z}}, base, stamp += 0.1), base);
  };
  see(0.0);
  see(0.0);
  EXPECT_EQ(see(0.3).cells_in_conflict, 1);
  EXPECT_NEAR(map.at(cell)->height_m, 0.0, 1e-6);
  see(0.0);  // what agrees again ends the conflict
  see(0.3);
  see(0.3);
  EXPECT_NEAR(map.at(cell)->height_m, 0.0, 1e-6);
  EXPECT_EQ(see(0.3).cells_started, 1);
  EXPECT_NEAR(map.at(cell)->height_m, 0.3, 1e-6);
}

TEST(ElevationMap, CellsStayWhereTheyAreWhenTheRobotMovesAndReturns) {
  ElevationMap map(plainParams());
  Rng rng(2);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4000; ++i)
    points.emplace_back(rng.uniform(-3.9, 3.9), rng.uniform(-3.9, 3.9), rng.uniform(-0.1, 0.1));
  map.insert(scanOfPoints(points, baseAt(0, 0), 0.0), baseAt(0, 0));
  std::map<std::pair<int, int>, double> before;
  for (int y = -100; y <= 100; ++y)
    for (int x = -100; x <= 100; ++x)
      if (const auto cell = map.at({x, y})) before[{x, y}] = cell->height_m;
  ASSERT_GT(before.size(), 2000U);
  for (const auto& [x, y] : {std::pair(1.0, 0.5), std::pair(1.7, -2.3), std::pair(0.0, 0.0)}) {
    map.insert(scanOfPoints({}, baseAt(x, y), 1.0), baseAt(x, y));
    for (auto cell = before.begin(); cell != before.end();)
      cell = map.grid().contains({cell->first.first, cell->first.second}) ? std::next(cell)
                                                                          : before.erase(cell);
  }
  int kept = 0;
  for (int y = -100; y <= 100; ++y)
    for (int x = -100; x <= 100; ++x) {
      const auto cell = map.at({x, y});
      EXPECT_EQ(cell.has_value(), before.count({x, y}) > 0) << x << " " << y;
      if (!cell) continue;
      EXPECT_EQ(cell->height_m, (before[{x, y}]));
      ++kept;
    }
  EXPECT_GT(kept, 500);
  map.insert(scanOfPoints({}, baseAt(500, 0), 2.0), baseAt(500, 0));
  map.insert(scanOfPoints({}, baseAt(0, 0), 3.0), baseAt(0, 0));
  EXPECT_FALSE(map.at({0, 0}).has_value()) << "nothing survives a jump out of the window";
}

TEST(ElevationMap, OverhangsAndCeilingsAreNoGround) {
  sim::WorldMesh mesh;
  addSlab(mesh, -10, 20, -10, 10, 0.0);
  test::addBox(mesh, {1.5F, -1.5F, 1.2F}, {2.5F, 1.5F, 1.4F});       // a slab in the air
  test::addBox(mesh, {-10.0F, -10.0F, 1.9F}, {20.0F, 10.0F, 2.5F});  // a low roof
  const sim::MeshScene scene(mesh);
  TerrainMap terrain{TerrainParams{}};
  walk(terrain, scene, -1.5, 0.5, Sight::kLidarAndCamera);
  int below = 0;
  int high = 0;
  for (const TerrainPoint& point : terrain.freeze()->points()) {
    const bool is_under_slab = point.position.x() > 1.48 && point.position.x() < 2.52 &&
                               std::fabs(point.position.y()) < 1.52;
    below += is_under_slab ? 1 : 0;
    high += point.position.z() > 0.05 ? 1 : 0;
    if (is_under_slab) {
      EXPECT_LT(point.position.z(), 0.05) << point.position.transpose();
    }
  }
  EXPECT_LE(high, 3) << "cells at the rim whose ground the slab hides";
  EXPECT_GT(below, 1500) << "the ground under the slab is seen";
}

TEST(ElevationMap, ARoofSeenBeforeTheGroundBelowItIsForgottenWhenThatIsSeenAround) {
  const ElevationParams params = plainParams();
  ElevationMap map(params);
  const Eigen::Isometry3d base = baseAt(0, 0);
  const double foot = base.translation().z() - params.base_height_m;
  const Eigen::Vector3d roof(2.62, 0.02, foot + 1.6);
  const Eigen::Vector3d post(2.62, 0.82, foot + 0.3);  // the lowest of it that is seen
  map.insert(scanOfPoints({roof, post}, base, 0.0), base);
  ASSERT_TRUE(map.at(map.grid().cellOf(roof.head<2>())).has_value()) << "nothing else is known";
  std::vector<Eigen::Vector3d> ramp;  // it falls from where the robot stands
  for (double x = 0.62; x < 3.5; x += 0.04)
    for (double y = -1.0; y < 1.2; y += 0.04) {
      const Eigen::Vector3d at(x, y, foot - 0.3 * (x - 0.6));
      const auto cell = map.grid().cellOf(at.head<2>());
      if (cell != map.grid().cellOf(roof.head<2>()) && cell != map.grid().cellOf(post.head<2>()))
        ramp.push_back(at);
    }
  for (int i = 1; i < 5; ++i) map.insert(scanOfPoints(ramp, base, 0.1 * i), base);
  EXPECT_FALSE(map.at(map.grid().cellOf(roof.head<2>())).has_value());
  EXPECT_TRUE(map.at(map.grid().cellOf(post.head<2>())).has_value()) << "it stands on the ground";
}

TEST(ElevationMap, WallsStandOutAndTheFloorBesideThemDoesNot) {
  sim::WorldMesh mesh;
  test::addBox(mesh, {-10.0F, -1.5F, 0.0F}, {20.0F, 1.5F, 3.0F});  // a tunnel
  const sim::MeshScene scene(mesh);
  TerrainMap terrain{TerrainParams{}};
  walk(terrain, scene, -0.5, 1.0, Sight::kLidarAndCamera);
  const auto view = terrain.freeze();
  int high = 0;
  for (double x = 1.5; x < 4.0; x += 0.04) {
    for (const double y : {-1.5, 1.5})  // the wall lies on the border of two cells
      for (const double dy : {-0.02, 0.02})
        high += view->groundHeight(Eigen::Vector2d(x, y + dy)).value_or(0.0) > 0.5 ? 1 : 0;
    EXPECT_LT(view->groundHeight(Eigen::Vector2d(x, 0.9)).value_or(0.0), 0.05);
  }
  EXPECT_GT(high, 100) << "of 125 cells of wall";
  EXPECT_EQ(terrain.checkPath({{{1.0, 0, 0.5}, 0}, {{3.0, 0, 0.5}, 0}}).status,
            PathGround::kTraversable);
  EXPECT_EQ(terrain.checkPath({{{1.0, 0, 0.5}, 0}, {{3.0, 1.2, 0.5}, 0}}).status,
            PathGround::kUntraversable);
}

TEST(ElevationMap, BadPointsAreCountedAndChangeNothing) {
  ElevationMap map{ElevationParams{}};
  const Eigen::Isometry3d base = baseAt(0, 0);
  Scan scan = scanOfPoints({{1.0, 0.0, 0.0}}, base, 0.0);
  scan.points.emplace_back(kNan, 0.0F, 0.0F);
  scan.points.emplace_back(1.0F, 0.0F, std::numeric_limits<float>::infinity());
  scan.points.emplace_back(3e38F, 3e38F, 3e38F);
  scan.points.emplace_back(0.3F, 0.2F, -0.1F);  // the robot's own leg
  scan.points.emplace_back(30.0F, 0.0F, 0.0F);
  scan.points.emplace_back(1.0F, 0.0F, 5.0F);
  const ElevationUpdate update = map.insert(scan, base);
  EXPECT_EQ(update.verdict, ScanVerdict::kUsed);
  EXPECT_EQ(update.points, 7);
  EXPECT_EQ(update.dropped_not_finite, 3);
  EXPECT_EQ(update.dropped_self, 1);
  EXPECT_EQ(update.dropped_outside, 1);
  EXPECT_EQ(update.dropped_high, 1);
  EXPECT_EQ(update.cells_started, 1);
}

TEST(ElevationMap, ScansWithoutPointsAreEmptyAndOddPosesRefused) {
  ElevationMap map{ElevationParams{}};
  const Eigen::Isometry3d base = baseAt(0, 0);
  EXPECT_EQ(map.insert(scanOfPoints({}, base, 0.0), base).verdict, ScanVerdict::kEmpty);
  const Scan good = scanOfPoints({{1.0, 0.0, 0.0}}, base, 0.0);
  std::vector<std::pair<Scan, Eigen::Isometry3d>> odd(5, {good, base});
  odd[0].first.T_world_sensor.translation().x() = kNan;
  odd[1].first.T_world_sensor.linear() *= 2.0;
  odd[2].first.T_world_sensor.translation().x() = 50.0;
  odd[3].second.translation().z() = std::numeric_limits<double>::infinity();
  odd[4].first.stamp_s = kNan;
  for (const auto& [scan, pose] : odd)
    EXPECT_EQ(map.insert(scan, pose).verdict, ScanVerdict::kRefused);
  EXPECT_FALSE(map.at(map.grid().cellOf({1.0, 0.0})).has_value());
  EXPECT_EQ(map.insert(good, base).verdict, ScanVerdict::kUsed);
}

TEST(ElevationMap, AssumedGroundGivesWayToWhatIsSeen) {
  ElevationMap map{ElevationParams{}};
  map.assumeGroundUnder(baseAt(0, 0));
  const CellIndex cell = map.grid().cellOf({0.5, 0.3});
  ASSERT_TRUE(map.at(cell).has_value());
  EXPECT_EQ(map.at(cell)->height_m, 0.0);
  EXPECT_FALSE(map.at(map.grid().cellOf({0.7, 0.0})).has_value()) << "beyond the body";
  map.insert(scanOfPoints({{0.5, 0.3, 0.03}}, baseAt(0, 0), 0.1), baseAt(0, 0));
  EXPECT_GT(map.at(cell)->height_m, 0.025);
}

TEST(ElevationMap, TheSameScansGiveTheSameMapBitByBit) {
  Rng rng(9);
  std::vector<Scan> scans;
  for (int i = 0; i < 5; ++i)
    scans.push_back(scanOfPoints(hillyPoints(rng, baseAt(0.1 * i, 0).translation(), 0.04),
                                 baseAt(0.1 * i, 0), 0.1 * i));
  ElevationMap a{ElevationParams{}};
  ElevationMap b{ElevationParams{}};
  for (ElevationMap* map : {&a, &b})
    for (int i = 0; i < 5; ++i) map->insert(scans[static_cast<std::size_t>(i)], baseAt(0.1 * i, 0));
  for (std::size_t slot = 0; slot < a.heights().size(); ++slot) {
    EXPECT_TRUE(a.heights()[slot] == b.heights()[slot] ||
                (std::isnan(a.heights()[slot]) && std::isnan(b.heights()[slot])));
    EXPECT_EQ(a.rayBounds()[slot], b.rayBounds()[slot]);
  }
}

}  // namespace
}  // namespace spelunk::terrain
