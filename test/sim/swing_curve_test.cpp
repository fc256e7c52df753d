#include "spelunk/sim/swing_curve.h"

#include <gtest/gtest.h>

#include "support/meshes.h"
#include "support/terrain.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;

struct Ground {
  explicit Ground(const WorldMesh& mesh) : scene(mesh), search(scene, WalkerParams{}) {}
  MeshScene scene;
  FootholdSearch search;
};

TEST(SwingCurve, LeavesAndArrivesAtRest) {
  const Ground ground(test::profile({{-5, 0}, {5, 0}}, 4));
  const SwingCurve curve({0, 0, 0}, {0.3, 0.05, 0}, 0.1, 0.5, ground.search);
  EXPECT_LT((curve.at(0.0) - Vector3d(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((curve.at(1.0) - Vector3d(0.3, 0.05, 0)).norm(), 1e-12);
  EXPECT_LT((curve.at(0.001) - curve.at(0.0)).norm(), 1e-5);
  EXPECT_LT((curve.at(1.0) - curve.at(0.999)).norm(), 1e-5);
  EXPECT_NEAR(curve.at(0.5).z(), 0.1, 1e-9);
  EXPECT_NEAR(curve.top(), 0.1, 1e-9);
}

TEST(SwingCurve, HasNoJumps) {
  const Ground ground(test::step(0.2F));
  const SwingCurve curve({2.8, 0, 0}, {3.1, 0, 0.2}, 0.1, 0.6, ground.search);
  for (int k = 0; k < 1000; ++k)
    EXPECT_LT((curve.at(0.001 * (k + 1)) - curve.at(0.001 * k)).norm(), 0.003);
}

TEST(SwingCurve, ClearsAnObstacleBetweenItsEnds) {
  WorldMesh mesh = test::profile({{-5, 0}, {5, 0}}, 4);
  test::addBox(mesh, {0.12F, -1.0F, -0.1F}, {0.2F, 1.0F, 0.15F});
  const Ground ground(mesh);
  const SwingCurve curve({0, 0, 0}, {0.32, 0, 0}, 0.08, 0.5, ground.search);
  EXPECT_NEAR(curve.top(), 0.15 + 0.08, 1e-6);
  for (int k = 0; k <= 100; ++k) {
    const Vector3d foot = curve.at(0.01 * k);
    if (foot.x() <= 0.1 || foot.x() >= 0.22) continue;
    EXPECT_GT(foot.z(), 0.17) << foot.transpose();
  }
}

TEST(SwingCurve, RisesAboveTheHigherEnd) {
  const Ground ground(test::step(0.2F));
  const SwingCurve up({2.8, 0, 0}, {3.1, 0, 0.2}, 0.1, 0.6, ground.search);
  const SwingCurve down({3.1, 0, 0.2}, {2.8, 0, 0}, 0.1, 0.6, ground.search);
  EXPECT_NEAR(up.top(), 0.3, 1e-6);
  EXPECT_NEAR(down.top(), 0.3, 1e-6);
}

TEST(SwingCurve, GoesElsewhereWithoutAJump) {
  WorldMesh mesh = test::profile({{-5, 0}, {5, 0}}, 4);
  test::addBox(mesh, {0.25F, -1.0F, -0.1F}, {0.6F, 1.0F, 0.15F});
  const Ground ground(mesh);
  const SwingCurve before({0, 0, 0}, {0.2, 0, 0}, 0.08, 0.5, ground.search);
  for (const double share : {0.1, 0.3, 0.5}) {
    SwingCurve curve = before;
    curve.redirect(share, {0.35, 0.1, 0.15}, 0.5, ground.search);
    EXPECT_LT((curve.at(share) - before.at(share)).norm(), 1e-12) << share;
    EXPECT_LT((curve.at(1.0) - Vector3d(0.35, 0.1, 0.15)).norm(), 1e-12) << share;
    EXPECT_NEAR(curve.top(), 0.15 + 0.08, 1e-6) << share;
    for (double now = share; now < 1.0; now += 0.001)
      EXPECT_LT((curve.at(now + 0.001) - curve.at(now)).norm(), 0.004) << share << " " << now;
    for (double now = share; now < 1.0; now += 0.01) {
      const Vector3d foot = curve.at(now);
      EXPECT_TRUE(foot.x() <= 0.25 || foot.z() > 0.15) << share << " " << foot.transpose();
    }
  }
}

TEST(SwingCurve, StaysUpWhenSentBackToLowerGround) {
  const Ground ground(test::step(0.2F));
  SwingCurve curve({2.8, 0, 0}, {3.1, 0, 0.2}, 0.1, 0.6, ground.search);
  curve.redirect(0.4, {2.9, 0, 0}, 0.6, ground.search);
  EXPECT_NEAR(curve.top(), 0.3, 1e-6);
  EXPECT_LT((curve.at(1.0) - Vector3d(2.9, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace spelunk::sim
