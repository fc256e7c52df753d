#include "spelunk/terrain/footprint.h"

#include <gtest/gtest.h>

#include <limits>

#include "spelunk/common/contract.h"
#include "terrain_worlds.h"

namespace spelunk::terrain {
namespace {

/// Rubble with holes and unseen places, seen by a camera.
TerrainMap rubble() {
  sim::WorldMesh mesh = groundWithHole(2.2, 0.5, 1.0);
  test::addBox(mesh, {1.5F, 0.8F, -0.1F}, {1.8F, 1.1F, 0.5F});
  test::addBox(mesh, {1.4F, -1.2F, -0.1F}, {1.7F, -0.9F, 0.1F});
  const sim::MeshScene scene(mesh);
  TerrainMap terrain{TerrainParams{}};
  terrain.assumeGroundUnder(baseAt(0, 0));
  walk(terrain, scene, 0.0, 0.5, Sight::kLidarAndCamera);
  return terrain;
}

/// Every covered cell asked whether it lies in the rectangle.
bool lies(const Eigen::Vector2d& point, const Pose& pose, const FootprintParams& params) {
  const Eigen::Vector2d d = point - pose.position.head<2>();
  const double c = std::cos(pose.yaw);
  const double s = std::sin(pose.yaw);
  return std::fabs(d.x() * c + d.y() * s) <= 0.5 * params.footprint_length_m &&
         std::fabs(d.y() * c - d.x() * s) <= 0.5 * params.footprint_width_m;
}

PathGroundCheck checkPlainly(const TerrainView& view, const Path& path,
                             const FootprintParams& params, const std::optional<Pose>& standing) {
  PathGroundCheck check;
  const Path poses = resampled(path, params.pose_spacing_m);
  const int reach = static_cast<int>(1.5 / view.grid().cell());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) check.arc_m += distance(poses[i - 1], poses[i]);
    const CellIndex middle = view.grid().cellOf(poses[i].position.head<2>());
    int cells = 0, unknown = 0, outside = 0, bad = 0;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const CellIndex cell = middle + CellIndex(x, y);
        const Eigen::Vector2d centre = view.grid().centreOf(cell);
        if (!lies(centre, poses[i], params)) continue;
        ++cells;
        if (standing && lies(centre, *standing, params)) continue;
        const GroundClass ground = view.classAt(cell);
        if (!view.covers(cell))
          ++outside;
        else if (ground == GroundClass::kUnknown)
          ++unknown;
        else if (ground != GroundClass::kTraversable)
          ++bad;
      }
    check.unknown_share = std::max(check.unknown_share, 1.0 * unknown / cells);
    check.outside_share = std::max(check.outside_share, 1.0 * outside / cells);
    if (bad * view.grid().cell() * view.grid().cell() > params.bad_area_max_m2)
      check.status = PathGround::kUntraversable;
    else if (1.0 * unknown / cells > params.unknown_share_max)
      check.status = PathGround::kUnknown;
    if (check.status != PathGround::kTraversable) break;
  }
  return check;
}

TEST(Footprint, EqualsAskingEveryCell) {
  TerrainMap terrain = rubble();
  const auto view = terrain.freeze();
  Rng rng(3);
  std::array<int, 3> by_status{};
  for (int i = 0; i < 300; ++i) {
    const Path path{{{rng.uniform(0.3, 2.0), rng.uniform(-1.0, 1.0), 0.5}, rng.uniform(-4, 4)},
                    {{rng.uniform(0.3, 4.0), rng.uniform(-1.5, 1.5), 0.5}, rng.uniform(-4, 4)}};
    FootprintParams params;
    params.footprint_length_m = rng.uniform(0.2, 1.2);
    params.footprint_width_m = rng.uniform(0.1, 0.8);
    const auto standing = i % 2 == 0 ? std::optional<Pose>(path.front()) : std::nullopt;
    const PathGroundCheck ours = checkPath(*view, path, params, standing);
    const PathGroundCheck plain = checkPlainly(*view, path, params, standing);
    ASSERT_EQ(ours.status, plain.status) << i;
    EXPECT_DOUBLE_EQ(ours.arc_m, plain.arc_m);
    EXPECT_DOUBLE_EQ(ours.unknown_share, plain.unknown_share);
    EXPECT_DOUBLE_EQ(ours.outside_share, plain.outside_share);
    ++by_status[static_cast<std::size_t>(ours.status)];
  }
  for (const int count : by_status) EXPECT_GT(count, 15) << "each outcome is provoked";
}

TEST(Footprint, TheYawDecidesWhereARobotFits) {
  sim::WorldMesh mesh;
  test::addBox(mesh, {-10.0F, -0.8F, 0.0F}, {20.0F, 0.8F, 3.0F});  // a tunnel of 1.6 m
  const sim::MeshScene scene(mesh);
  TerrainParams params;
  params.traversability.slope_window_m = 0.12;  // a narrow plane: the walls stay walls
  TerrainMap terrain(params);
  walk(terrain, scene, -0.5, 0.5, Sight::kLidarAndCamera);
  const Pose along{{2.0, 0.0, 0.5}, 0.0};
  const Pose across{{2.0, 0.0, 0.5}, M_PI / 2.0};
  FootprintParams narrow;
  narrow.footprint_length_m = 1.5;
  narrow.footprint_width_m = 0.6;
  EXPECT_EQ(checkPath(*terrain.freeze(), {along}, narrow).status, PathGround::kTraversable);
  EXPECT_EQ(checkPath(*terrain.freeze(), {across}, narrow).status, PathGround::kUntraversable);
}

TEST(Footprint, WhereARobotStandsBearsItButNotWhereItSteps) {
  const sim::MeshScene scene(groundWithHole(0.7, 0.6, 1.0));
  TerrainMap terrain{TerrainParams{}};
  terrain.assumeGroundUnder(baseAt(0, 0));
  walk(terrain, scene, -0.5, 0.0, Sight::kLidarAndCamera);
  FootprintParams params;
  params.footprint_length_m = 0.9;
  params.footprint_width_m = 0.6;
  const auto view = terrain.freeze();
  const Pose at_the_edge{{0.4, 0.0, 0.5}, 0.0};  // 15 cm over the hole
  const Path back{at_the_edge, {{-0.2, 0.0, 0.5}, 0.0}};
  const Path on{at_the_edge, {{1.0, 0.0, 0.5}, 0.0}};
  EXPECT_EQ(checkPath(*view, back, params).status, PathGround::kUntraversable);
  EXPECT_EQ(checkPath(*view, back, params, at_the_edge).status, PathGround::kTraversable);
  const PathGroundCheck check = checkPath(*view, on, params, at_the_edge);
  EXPECT_EQ(check.status, PathGround::kUntraversable);
  EXPECT_LT(check.arc_m, 0.2);
  EXPECT_GT(check.where.x(), 0.85) << "the hole's part that does not bear it";
}

TEST(Footprint, BeyondTheMapIsPresumedTraversableAndSaid) {
  TerrainMap terrain = rubble();
  const PathGroundCheck check = terrain.checkPath({{{7.0, 0, 0.5}, 0}, {{9.0, 0, 0.5}, 0}});
  EXPECT_EQ(check.status, PathGround::kTraversable);
  EXPECT_EQ(check.outside_share, 1.0);
  EXPECT_NEAR(check.arc_m, 2.0, 1e-9);
}

TEST(Footprint, AnEmptyPathIsFineAndABrokenOneRefused) {
  TerrainMap terrain = rubble();
  EXPECT_EQ(terrain.checkPath({}).status, PathGround::kTraversable);
  EXPECT_THROW((void)terrain.checkPath({{{std::numeric_limits<double>::quiet_NaN(), 0, 0}, 0}}),
               Precondition);
}

}  // namespace
}  // namespace spelunk::terrain
