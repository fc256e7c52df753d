#include "spelunk/sim/foothold_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spelunk/common/rng.h"
#include "support/meshes.h"
#include "support/terrain.h"

namespace spelunk::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d standingAt(const Vector3d& position) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translate(position);
  return pose;
}

struct Ground {
  explicit Ground(const WorldMesh& mesh) : scene(mesh), search(scene, params) {}
  WalkerParams params;
  MeshScene scene;
  FootholdSearch search;
  Leg leg{params, 0};
};

TEST(FootholdSearch, TakesTheWantedPlaceOnFlatGround) {
  const Ground ground(test::profile({{-5, 0}, {5, 0}}, 8));
  const Isometry3d base = standingAt({0, 0, 0.5});
  const Vector3d wanted = base * ground.leg.root() + Vector3d(0.1, 0.03, 0.7);
  const auto found = ground.search.find(ground.leg, base, wanted);
  ASSERT_TRUE(found);
  EXPECT_LT((found->position - Vector3d(wanted.x(), wanted.y(), 0.0)).norm(), 1e-6);
  EXPECT_LT((found->normal - Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(FootholdSearch, KeepsAwayFromAnEdge) {
  const Ground ground(test::step(-0.1F));
  const Isometry3d base = standingAt({2.7, 0, 0.45});
  const Vector3d wanted(2.99, 0.24, 0.0);  // 1 cm before the edge
  const auto found = ground.search.find(ground.leg, base, wanted);
  ASSERT_TRUE(found);
  EXPECT_GE(std::abs(found->position.x() - 3.0), 0.039);
  EXPECT_NEAR((found->position - wanted).head<2>().norm(), 0.05, 1e-5) << "not the nearest";
}

TEST(FootholdSearch, FindsNothingOverAHoleOrOutOfReach) {
  const Ground ground(test::trench(2.0F, 2.0F));
  EXPECT_FALSE(ground.search.find(ground.leg, standingAt({3.7, 0, 0.5}), {4.0, 0.24, 0.0}));
  EXPECT_FALSE(ground.search.find(ground.leg, standingAt({0, 0, 0.5}), {1.2, 0.24, 0.0}));
  EXPECT_FALSE(ground.search.find(ground.leg, standingAt({0, 0, 0.75}), {0.3, 0.24, 0.0}));
}

TEST(FootholdSearch, RefusesSteepGround) {
  const Ground gentle(test::ramp(35.0F, 5.0F));
  const Ground steep(test::ramp(41.0F, 5.0F));
  const auto poseOn = [](double degrees) {
    return standingAt({5.2, 0, 2.2 * std::tan(degrees * M_PI / 180.0) + 0.5});
  };
  EXPECT_TRUE(gentle.search.find(gentle.leg, poseOn(35.0), {5.5, 0.24, 0.0}));
  EXPECT_FALSE(steep.search.find(steep.leg, poseOn(41.0), {5.5, 0.24, 0.0}));
}

TEST(FootholdSearch, DoesNotStepBehindAWall) {
  WorldMesh mesh = test::profile({{-5, 0}, {5, 0}}, 8);
  test::addBox(mesh, {0.36F, -3.0F, -0.1F}, {0.37F, 3.0F, 1.5F});
  const Ground ground(mesh);
  const Isometry3d base = standingAt({0, 0, 0.5});
  const auto found = ground.search.find(ground.leg, base, {0.45, 0.24, 0.0});
  ASSERT_TRUE(found);
  EXPECT_LT(found->position.x(), 0.36);
}

TEST(FootholdSearch, WhatItFindsOnRoughGroundCanCarryAFoot) {
  const Ground ground(test::roughGround(20.0F, 12.0F, 0.7F, 9));
  const double normal_z_min = std::cos(ground.params.foothold_slope_max_deg * M_PI / 180.0);
  Rng rng(4);
  int found_count = 0;
  for (int k = 0; k < 300; ++k) {
    const Isometry3d base =
        standingAt({rng.uniform(-3.0, 12.0), rng.uniform(-4.0, 4.0), rng.uniform(0.5, 0.9)});
    const Vector3d wanted =
        base * ground.leg.root() + Vector3d(rng.uniform(-0.2, 0.2), rng.uniform(-0.1, 0.1), 0.0);
    const auto found = ground.search.find(ground.leg, base, wanted);
    if (!found) continue;
    ++found_count;
    EXPECT_LT(ground.scene.distanceTo(found->position, 1.0), 1e-4);
    EXPECT_GE(found->normal.z(), normal_z_min);
    EXPECT_TRUE(ground.leg.anglesFor(base.inverse() * found->position));
    EXPECT_LE((found->position - wanted).head<2>().norm(), ground.params.foothold_search_m + 1e-6);
  }
  EXPECT_GT(found_count, 150);
}

}  // namespace
}  // namespace spelunk::sim
