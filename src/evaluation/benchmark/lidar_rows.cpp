#include <btBulletCollisionCommon.h>

#include <cmath>

#include "bench.h"

namespace spelunk::benchmark {
namespace {

/// The mesh as Bullet holds it: a bounding volume hierarchy of triangles in a collision world.
class BulletMesh {
 public:
  explicit BulletMesh(const sim::WorldMesh& mesh) {
    const auto at = [&](int vertex) {
      const Eigen::Vector3f& p = mesh.vertices[static_cast<std::size_t>(vertex)];
      return btVector3(p.x(), p.y(), p.z());
    };
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      triangles_.addTriangle(at(triangle.x()), at(triangle.y()), at(triangle.z()));
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    object_.setCollisionShape(shape_.get());
    world_.addCollisionObject(&object_);
  }
  ~BulletMesh() { world_.removeCollisionObject(&object_); }
  BulletMesh(const BulletMesh&) = delete;
  BulletMesh& operator=(const BulletMesh&) = delete;

  float rangeOf(const Eigen::Vector3f& origin, const Eigen::Vector3f& ray, float range_max) const {
    const btVector3 from(origin.x(), origin.y(), origin.z());
    const btVector3 to = from + btScalar(range_max) * btVector3(ray.x(), ray.y(), ray.z());
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world_.rayTest(from, to, hit);
    return hit.hasHit() ? static_cast<float>(hit.m_closestHitFraction) * range_max : range_max;
  }

 private:
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  btCollisionObject object_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

}  // namespace

std::vector<Row> lidarRows(const MineWalk& walk) {
  constexpr float kRange_m = 50.0F;
  constexpr float kSame_m = 0.01F;
  const BulletMesh bullet(walk.mesh);
  double plain_s = 0.0;
  double ours_s = 0.0;
  std::size_t rays = 0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < walk.scans.size(); i += 4) {
    const Eigen::Vector3f origin = walk.scans[i].T_world_sensor.translation().cast<float>();
    std::vector<float> ours;
    std::vector<float> plain;
    plain_s += secondsOf([&] {
      for (const Eigen::Vector3f& ray : walk.directions)
        plain.push_back(bullet.rangeOf(origin, ray, kRange_m));
    });
    ours_s += secondsOf([&] { walk.scene.castFan(origin, walk.directions, kRange_m, ours); });
    rays += ours.size();
    for (std::size_t k = 0; k < ours.size(); ++k)
      different += std::fabs(ours[k] - plain[k]) > kSame_m ? 1 : 0;
  }
  const double to_ns = 1e9 / static_cast<double>(rays);
  return {{"LiDAR rays, 16 x 1800, 50 m", "Bullet rayTest", "ns a ray", plain_s * to_ns,
           ours_s * to_ns, 18.0, different * 10000 < rays,
           "1 cm; " + std::to_string(different) + " of " + std::to_string(rays) + " differ"}};
}

}  // namespace spelunk::benchmark
