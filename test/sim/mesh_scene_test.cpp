#include "spelunk/sim/mesh_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "spelunk/common/contract.h"
#include "spelunk/common/rng.h"
#include "spelunk/common/sensor_model.h"
#include "spelunk/sim/triangle_distance.h"
#include "support/meshes.h"

namespace spelunk::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d randomPoint(Rng& rng, const Vector3d& low, const Vector3d& high) {
  const double x = rng.uniform(low.x(), high.x());
  const double y = rng.uniform(low.y(), high.y());
  return {x, y, rng.uniform(low.z(), high.z())};
}

/// Random triangles of about a metre in a cube of 10 m.
WorldMesh triangleCloud(int count, std::uint64_t seed) {
  Rng rng(seed);
  WorldMesh mesh;
  for (int k = 0; k < count; ++k) {
    const Vector3d centre = randomPoint(rng, Vector3d::Constant(-5), Vector3d::Constant(5));
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(
          (centre + randomPoint(rng, Vector3d::Constant(-1), Vector3d::Constant(1))).cast<float>());
    mesh.triangles.emplace_back(3 * k, 3 * k + 1, 3 * k + 2);
  }
  return mesh;
}

Triangle triangleOf(const WorldMesh& mesh, std::size_t index, const Vector3d& origin) {
  Triangle triangle;
  for (std::size_t k = 0; k < 3; ++k)
    triangle[k] =
        mesh.vertices[static_cast<std::size_t>(mesh.triangles[index][static_cast<int>(k)])]
            .cast<double>() -
        origin;
  return triangle;
}

/// Moeller and Trumbore's test for one triangle; infinity if missed.
double rayTriangle(const Triangle& triangle, const Vector3d& direction) {
  const Vector3d e1 = triangle[1] - triangle[0];
  const Vector3d e2 = triangle[2] - triangle[0];
  const Vector3d p = direction.cross(e2);
  const double det = e1.dot(p);
  if (det == 0.0) return std::numeric_limits<double>::infinity();
  const double u = -triangle[0].dot(p) / det;
  const Vector3d q = (-triangle[0]).cross(e1);
  const double v = direction.dot(q) / det;
  const double t = e2.dot(q) / det;
  const bool is_hit = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0;
  return is_hit ? t : std::numeric_limits<double>::infinity();
}

double bruteForceRange(const WorldMesh& mesh, const Vector3d& origin, const Vector3d& direction) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    best = std::min(best, rayTriangle(triangleOf(mesh, k, origin), direction));
  return best;
}

double bruteForceBoxDistance(const WorldMesh& mesh, const Vector3d& centre, const Vector3d& size) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    best = std::min(best, boxTriangleDistanceSquared(0.5 * size, triangleOf(mesh, k, centre)));
  return std::sqrt(best);
}

TEST(MeshScene, RangesAgreeWithBruteForce) {
  const WorldMesh mesh = triangleCloud(300, 5);
  const MeshScene scene(mesh);
  Rng rng(6);
  const Vector3f origin(0.1F, -0.2F, 0.3F);
  std::vector<Vector3f> directions;
  for (int k = 0; k < 3001; ++k)  // no multiple of a packet
    directions.push_back(
        randomPoint(rng, Vector3d::Constant(-1), Vector3d::Constant(1)).normalized().cast<float>());
  std::vector<float> ranges;
  scene.castFan(origin, directions, 8.0F, ranges);
  ASSERT_EQ(ranges.size(), directions.size());
  int differing = 0;
  int missed = 0;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const double wanted =
        std::min(8.0, bruteForceRange(mesh, origin.cast<double>(), directions[k].cast<double>()));
    if (std::abs(ranges[k] - wanted) > 1e-4) ++differing;
    if (ranges[k] == 8.0F) ++missed;
  }
  EXPECT_LE(differing, 1);  // a ray through an edge may see it or not
  EXPECT_GT(missed, 10);
  EXPECT_LT(missed, 2000);
}

TEST(MeshScene, SingleRaysAgreeWithBruteForce) {
  const WorldMesh mesh = triangleCloud(300, 15);
  const MeshScene scene(mesh);
  Rng rng(16);
  int hits = 0;
  int differing = 0;
  for (int k = 0; k < 1500; ++k) {
    const Vector3d origin = randomPoint(rng, Vector3d::Constant(-4), Vector3d::Constant(4));
    const Vector3d direction =
        randomPoint(rng, Vector3d::Constant(-1), Vector3d::Constant(1)).normalized();
    const double wanted = bruteForceRange(mesh, origin, direction);
    const auto hit = scene.castRay(origin, direction, 6.0);
    if (hit.has_value() != (wanted < 6.0) || (hit && std::abs(hit->range_m - wanted) > 1e-4))
      ++differing;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->normal.norm(), 1.0, 1e-9);
    EXPECT_LE(hit->normal.dot(direction), 0.0) << "the normal looks away from the ray";
  }
  EXPECT_LE(differing, 1);  // a ray through an edge may see it or not
  EXPECT_GT(hits, 300);
  EXPECT_LT(hits, 1400);
}

TEST(MeshScene, RangesDoNotDependOnNeighboursInAPacket) {
  const MeshScene scene(triangleCloud(500, 7));
  const std::vector<Vector3f> directions = rayDirections(SensorModel{});
  std::vector<float> in_order;
  scene.castFan({0.0F, 0.0F, 0.0F}, directions, 20.0F, in_order);
  Rng rng(8);
  std::vector<std::size_t> order(directions.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t k = order.size() - 1; k > 0; --k)
    std::swap(order[k], order[static_cast<std::size_t>(rng.below(static_cast<int>(k) + 1))]);
  std::vector<Vector3f> shuffled;
  for (const std::size_t index : order) shuffled.push_back(directions[index]);
  std::vector<float> ranges;
  scene.castFan({0.0F, 0.0F, 0.0F}, shuffled, 20.0F, ranges);
  int differing = 0;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (ranges[k] != in_order[order[k]]) ++differing;
  EXPECT_EQ(differing, 0);
}

TEST(MeshScene, ClosedRoomLeaksNoRay) {
  const MeshScene scene(test::boxRoom({13, 7, 3}));
  const std::vector<Vector3f> directions = rayDirections(SensorModel{});
  Rng rng(9);
  std::vector<float> ranges;
  for (int pose = 0; pose < 20; ++pose) {
    const Vector3d origin = randomPoint(rng, {-6, -3, 0.2}, {6, 3, 2.8});
    scene.castFan(origin.cast<float>(), directions, 50.0F, ranges);
    EXPECT_LT(*std::max_element(ranges.begin(), ranges.end()), 15.0F);
  }
}

TEST(MeshScene, KnowsRangesInARoom) {
  const MeshScene scene(test::boxRoom({10, 8, 3}));
  std::vector<float> ranges;
  scene.castFan({1.0F, 2.0F, 1.0F}, {Vector3f::UnitX(), -Vector3f::UnitY(), Vector3f::UnitZ()},
                5.0F, ranges);
  EXPECT_FLOAT_EQ(ranges[0], 4.0F);
  EXPECT_FLOAT_EQ(ranges[1], 5.0F);  // the wall is 6 m off
  EXPECT_FLOAT_EQ(ranges[2], 2.0F);
}

TEST(MeshScene, DistancesAgreeWithBruteForce) {
  const WorldMesh mesh = triangleCloud(60, 10);
  const MeshScene scene(mesh);
  Rng rng(11);
  int touching = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3d centre = randomPoint(rng, Vector3d::Constant(-8), Vector3d::Constant(8));
    const Vector3d size = randomPoint(rng, Vector3d::Constant(0.1), Vector3d::Constant(1.5));
    const double wanted_box = bruteForceBoxDistance(mesh, centre, size);
    const double wanted_point = bruteForceBoxDistance(mesh, centre, Vector3d::Zero());
    EXPECT_DOUBLE_EQ(scene.boxDistance(centre, size, 100.0), wanted_box);
    EXPECT_NEAR(scene.distanceTo(centre, 100.0), wanted_point, 1e-9);
    EXPECT_DOUBLE_EQ(scene.boxDistance(centre, size, 1.0), std::min(1.0, wanted_box));
    if (wanted_box == 0.0) ++touching;
  }
  EXPECT_GE(touching, 10);
}

TEST(MeshScene, DistancesInARoomFarFromTheOrigin) {
  WorldMesh mesh = test::boxRoom({10, 8, 3});
  for (Vector3f& vertex : mesh.vertices) vertex += Vector3f(1000.0F, -2000.0F, 0.0F);
  const MeshScene scene(mesh);
  EXPECT_NEAR(scene.distanceTo({1001.0, -2000.0, 1.5}, 10.0), 1.5, 1e-9);
  EXPECT_NEAR(scene.boxDistance({1004.0, -2000.0, 1.5}, {1.0, 1.0, 0.4}, 10.0), 0.5, 1e-9);
  EXPECT_EQ(scene.boxDistance({1004.6, -2000.0, 1.5}, {1.0, 1.0, 0.4}, 10.0), 0.0);
  EXPECT_EQ(scene.distanceTo({1001.0, -2000.0, 1.5}, 0.7), 0.7);
}

TEST(MeshScene, RefusesAnEmptyMesh) { EXPECT_THROW(MeshScene{WorldMesh{}}, Precondition); }

}  // namespace
}  // namespace spelunk::sim
