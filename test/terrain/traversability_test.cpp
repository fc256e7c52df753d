#include "spelunk/terrain/traversability.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

#include "spelunk/common/contract.h"
#include "terrain_worlds.h"

namespace spelunk::terrain {
namespace {

ElevationParams smallMap() {
  ElevationParams params;
  params.reach_m = 2.4;
  params.body_m.setZero();
  params.climb_deg = 60.0;
  params.clearance_m = 3.0;
  return params;
}

/// One point in the middle of every cell of the window.
void cover(ElevationMap& map, const std::function<double(double, double)>& height, double stamp_s,
           const Eigen::Isometry3d& base = baseAt(0, 0)) {
  Scan scan;
  scan.stamp_s = stamp_s;
  scan.T_world_sensor = base;
  map.insert(scan, base);
  const CellIndex first = map.grid().first();
  for (int y = 0; y < map.grid().side(); ++y)
    for (int x = 0; x < map.grid().side(); ++x) {
      const Eigen::Vector2d at = map.grid().centreOf(first + CellIndex(x, y));
      const double z = height(at.x(), at.y());
      if (!std::isnan(z))
        scan.points.push_back((base.inverse() * Eigen::Vector3d(at.x(), at.y(), z)).cast<float>());
    }
  map.insert(scan, base);
}

/// The quantities of one cell, straight from their definition, in doubles.
struct PlainShape {
  bool has_plane = false;
  double slope = 0.0, step = 0.0, roughness = 0.0;
};

PlainShape plainShape(const ElevationMap& map, const CellIndex& cell,
                      const TraversabilityParams& params) {
  const int k = static_cast<int>(std::lround(params.slope_window_m / map.grid().cell()));
  const int f = static_cast<int>(std::lround(params.step_window_m / map.grid().cell()));
  std::vector<Eigen::Vector3d> points;
  double low = 1e9;
  double high = -1e9;
  for (int y = -k; y <= k; ++y)
    for (int x = -k; x <= k; ++x) {
      const auto known = map.at(cell + CellIndex(x, y));
      if (!known) continue;
      points.emplace_back(x * map.grid().cell(), y * map.grid().cell(), known->height_m);
      if (std::max(std::abs(x), std::abs(y)) > f) continue;
      low = std::min(low, known->height_m);
      high = std::max(high, known->height_m);
    }
  PlainShape shape;
  shape.step = high - low;
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd A(n, 3);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& point = points[static_cast<std::size_t>(i)];
    A.row(i) << point.x(), point.y(), 1.0;
    b(i) = point.z();
  }
  const Eigen::Matrix2d spread =
      n > 0
          ? Eigen::Matrix2d((A.leftCols(2).rowwise() - A.leftCols(2).colwise().mean()).transpose() *
                            (A.leftCols(2).rowwise() - A.leftCols(2).colwise().mean()) /
                            static_cast<double>(n))
          : Eigen::Matrix2d::Zero();
  const double full = (2 * k + 1) * map.grid().cell() / std::sqrt(12.0);
  const double narrow = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()(0);
  shape.has_plane = n >= 6 && narrow >= 0.09 * full * full;
  if (!shape.has_plane) return shape;
  const Eigen::Vector3d plane = A.colPivHouseholderQr().solve(b);
  shape.slope = plane.head<2>().norm();
  shape.roughness = std::sqrt((A * plane - b).squaredNorm() / static_cast<double>(n));
  return shape;
}

/// Calls `check` for every cell that traversability is computed for.
template <class Check>
void forEachInner(const ElevationMap& map, const Traversability& traversability, Check&& check) {
  for (int y = traversability.margin(); y < map.grid().side() - traversability.margin(); ++y)
    for (int x = traversability.margin(); x < map.grid().side() - traversability.margin(); ++x)
      check(map.grid().first() + CellIndex(x, y));
}

void expectSame(const ElevationMap& map, const Traversability& a, const Traversability& b) {
  forEachInner(map, a, [&](const CellIndex& cell) {
    const std::size_t slot = map.grid().slotOf(cell);
    ASSERT_EQ(a.layers().ground_class[slot], b.layers().ground_class[slot]) << cell.transpose();
    if (a.layers().ground_class[slot] == GroundClass::kUnknown) return;
    ASSERT_EQ(a.layers().value[slot], b.layers().value[slot]) << cell.transpose();
  });
}

TEST(Traversability, KnowsSlopeStepAndRoughnessOfGroundMadeWithThem) {
  ElevationMap map(smallMap());
  cover(
      map, [](double x, double y) { return 0.2 * x - 0.1 * y; }, 0.0);
  Traversability plane({}, map.grid());
  plane.updateAll(map);
  ElevationMap rough_map(smallMap());
  cover(
      rough_map,
      [](double x, double y) {
        const auto parity = std::lround(std::floor(x / 0.04) + std::floor(y / 0.04));
        return parity % 2 == 0 ? 0.03 : -0.03;
      },
      0.0);
  Traversability rough({}, rough_map.grid());
  rough.updateAll(rough_map);
  forEachInner(map, plane, [&](const CellIndex& cell) {
    const std::size_t slot = map.grid().slotOf(cell);
    EXPECT_NEAR(plane.layers().slope[slot], std::hypot(0.2, 0.1), 1e-3);
    EXPECT_NEAR(plane.layers().step_m[slot], 4 * 0.04 * 0.3, 1e-4);
    EXPECT_LT(plane.layers().roughness_m[slot], 2e-3);
    EXPECT_NEAR(rough.layers().roughness_m[slot], 0.03, 1e-4);
    EXPECT_NEAR(rough.layers().step_m[slot], 0.06, 1e-5);
    EXPECT_LT(rough.layers().slope[slot], 1e-3);
  });
}

TEST(Traversability, EachLimitGivesItsOwnReason) {
  const std::vector<std::pair<std::function<double(double, double)>, GroundClass>> cases{
      {[](double x, double) { return 0.4 * x; }, GroundClass::kTraversable},
      {[](double x, double) { return 0.7 * x; }, GroundClass::kTooSteep},
      {[](double x, double) { return x < 0.0 ? 0.0 : 0.12; }, GroundClass::kTraversable},
      // A post: high, but too narrow to tilt the plane or to make it rough.
      {[](double x, double y) { return std::hypot(x, y) < 0.05 ? 0.35 : 0.0; }, GroundClass::kStep},
      {[](double x, double) { return std::lround(std::floor(x / 0.12)) % 2 == 0 ? 0.1 : -0.1; },
       GroundClass::kTooRough}};
  for (const auto& [height, expected] : cases) {
    ElevationMap map(smallMap());
    cover(map, height, 0.0);
    Traversability traversability({}, map.grid());
    traversability.updateAll(map);
    const std::size_t slot = map.grid().slotOf(map.grid().cellOf({0.01, 0.01}));
    EXPECT_EQ(traversability.layers().ground_class[slot], expected)
        << letterOf(expected) << " slope " << traversability.layers().slope[slot] << " step "
        << traversability.layers().step_m[slot] << " roughness "
        << traversability.layers().roughness_m[slot];
    if (expected == GroundClass::kTraversable)
      EXPECT_GT(traversability.layers().value[slot], 0.05F);
    else
      EXPECT_EQ(traversability.layers().value[slot], 0.0F);
  }
}

/// Bumps with unknown patches.
double patchy(double x, double y) {
  const long patch = std::lround(std::floor(x / 0.3) * 7 + std::floor(y / 0.2) * 3);
  if (patch % 4 == 0) return std::nan("");
  return 0.2 * std::sin(2.0 * x) + 0.15 * std::cos(3.0 * y) + (x > 0.5 ? 0.3 : 0.0);
}

TEST(Traversability, EqualsTheDefinitionOnPatchyGround) {
  ElevationMap map(smallMap());
  cover(map, patchy, 0.0);
  const TraversabilityParams params;
  Traversability traversability(params, map.grid());
  traversability.updateAll(map);
  int compared = 0;
  forEachInner(map, traversability, [&](const CellIndex& cell) {
    const std::size_t slot = map.grid().slotOf(cell);
    if (!map.at(cell)) {
      EXPECT_NE(traversability.layers().ground_class[slot], GroundClass::kTraversable);
      return;
    }
    const PlainShape shape = plainShape(map, cell, params);
    ASSERT_TRUE(shape.has_plane);
    EXPECT_NEAR(traversability.layers().slope[slot], shape.slope, 1e-3);
    EXPECT_NEAR(traversability.layers().step_m[slot], shape.step, 1e-5);
    EXPECT_NEAR(traversability.layers().roughness_m[slot], shape.roughness, 1e-3);
    const double slope = shape.slope / std::tan(30.0 * M_PI / 180.0);
    const double loss = 0.4 * slope + 0.3 * shape.step / 0.25 + 0.3 * shape.roughness / 0.08;
    const bool is_over = slope > 1.0 || shape.step > 0.25 || shape.roughness > 0.08;
    EXPECT_NEAR(traversability.layers().value[slot], is_over ? 0.0 : std::max(0.0, 1.0 - loss),
                5e-3);
    ++compared;
  });
  EXPECT_GT(compared, 3000);
}

TEST(Traversability, ALineOfCellsIsNoGroundToJudge) {
  ElevationMap map(smallMap());
  cover(
      map, [](double x, double y) { return std::fabs(y - 0.1 * x) < 0.03 ? 0.0 : std::nan(""); },
      0.0);
  Traversability traversability({}, map.grid());
  traversability.updateAll(map);
  for (const GroundClass ground : traversability.layers().ground_class)
    EXPECT_EQ(ground, GroundClass::kUnknown);
}

TEST(Traversability, IncrementalUpdatesEqualTheWholeBitByBit) {
  ElevationParams params = smallMap();
  params.growth_m2_per_m = 1e-3;
  ElevationMap map(params);
  Traversability incremental({}, map.grid());
  const sim::MeshScene scene(groundWithHole(1.2, 0.5, 1.0));
  Rng rng(4);
  Eigen::Vector2d at(-0.8, 0.0);
  for (int i = 0; i < 25; ++i) {
    at += Eigen::Vector2d(0.09 + (i == 12 ? 0.5 : 0.0), 0.05 * rng.normal());
    const Eigen::Isometry3d base = baseAt(at.x(), at.y(), 0.1 * rng.normal());
    const SensorModel sensor = i % 3 == 0 ? walkerLidar() : frontCamera();
    Scan scan = scanOf(scene, sensor, base, 0.1 * i, 0.01, static_cast<std::uint64_t>(i));
    if (i % 5 == 4) scan.points.resize(scan.points.size() / 50);  // so that tiles stay as they are
    map.insert(scan, base);
    incremental.note(map);
    if (i % 2 == 1) continue;
    incremental.update(map);
    Traversability whole({}, map.grid());
    whole.updateAll(map);
    expectSame(map, incremental, whole);
  }
}

TEST(Traversability, DropsEqualTheirDefinition) {
  ElevationMap map(smallMap());
  const sim::MeshScene scene(groundWithHole(1.2, 0.5, 1.0));
  for (int i = 0; i < 4; ++i) {
    const Eigen::Isometry3d base = baseAt(-0.4 + 0.1 * i, 0.0);
    map.insert(scanOf(scene, frontCamera(), base, 0.1 * i, 0.005, 3), base);
  }
  const TraversabilityParams params;
  Traversability traversability(params, map.grid());
  traversability.updateAll(map);
  const auto narrowed = [&](const CellIndex& cell, double sign) {  // extreme in a foot's window
    double best = -1e9;
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x)
        if (const auto known = map.at(cell + CellIndex(x, y)))
          best = std::max(best, sign * known->height_m);
    return sign * best;
  };
  const double slope = std::tan(params.drop_slope_deg * M_PI / 180.0);
  const int reach = static_cast<int>(std::lround(params.drop_window_m / 0.04));
  int drops = 0;
  forEachInner(map, traversability, [&](const CellIndex& cell) {
    if (map.at(cell)) return;
    double fall = -1e9;
    double floor = 1e9;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const CellIndex around = cell + CellIndex(x, y);
        if (!map.at(around)) continue;
        const double squared = 0.04 * 0.04 * (x * x + y * y);
        fall = std::max(
            fall, narrowed(around, -1.0) - slope * slope / (4.0 * params.drop_margin_m) * squared);
        floor = std::min(floor, narrowed(around, 1.0));
      }
    const double bound = map.rayBound(cell).value_or(1e9);
    const bool is_below_all =
        bound < fall - params.drop_margin_m && bound < floor - params.drop_margin_m;
    const bool is_drop = is_below_all || bound < fall - params.step_limit_m;
    const GroundClass ground = traversability.layers().ground_class[map.grid().slotOf(cell)];
    EXPECT_EQ(ground, is_drop ? GroundClass::kDrop : GroundClass::kUnknown) << cell.transpose();
    drops += is_drop ? 1 : 0;
  });
  EXPECT_GT(drops, 50);
}

TEST(Traversability, RefusesAWindowSmallerThanItsMargins) {
  EXPECT_THROW(Traversability({}, WindowGrid(0.04, 0.3)), Precondition);
}

}  // namespace
}  // namespace spelunk::terrain
