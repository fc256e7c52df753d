#include "spelunk/sim/mesh_scene.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "spelunk/common/contract.h"
#include "spelunk/common/log.h"
#include "spelunk/common/wide_loops.h"
#include "spelunk/sim/triangle_distance.h"

namespace spelunk::sim {
namespace {

/// Rays traced together. Neighbouring rays of a scan stay in one packet: they walk the same nodes.
constexpr std::size_t kPacket = 8;

/// Packets traced together; Embree walks a stream of them through the tree as one.
constexpr std::size_t kPackets = 8;
constexpr std::size_t kBatch = kPackets * kPacket;

/// Farther off from Embree's range (metres), the range to a triangle's plane is not believed.
constexpr float kRangeDoubt = 0.01F;

/// Embree would take the widest instruction set of the machine, and different ones round ranges
/// differently. AVX2 is the lowest that is 18 times faster than Bullet's rayTest in a mine (35 x;
/// AVX 19 x without margin, SSE4.2 12 x); its packets hold eight rays.
constexpr const char* kPinned = "threads=1,isa=avx2";
constexpr const char* kFallback = "threads=1,isa=sse4.2";

RTCDevice makeDevice() {
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  if (!has_avx2)
    log(LogLevel::kWarn,
        "this processor has no AVX2: simulated rays are slower, and runs may differ in the last "
        "digit from those of other machines");
  RTCDevice device = rtcNewDevice(has_avx2 ? kPinned : kFallback);
  if (device == nullptr) throw OutsideError("Embree cannot start; install libembree3 3.13");
  return device;
}

/// The plane of a triangle: normal * p = offset, the normal of any length.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

std::vector<Plane> planesOf(const WorldMesh& mesh) {
  std::vector<Plane> planes;
  planes.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices[static_cast<std::size_t>(triangle[k])].cast<double>();
    };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    planes.push_back({normal, normal.dot(corner(0))});
  }
  return planes;
}

/// What one distance query carries through the tree.
struct DistanceQuery {
  const WorldMesh* mesh;
  Eigen::Vector3d centre;
  Eigen::Vector3d half_extents;
  double best_squared;
};

Triangle triangleAt(const WorldMesh& mesh, unsigned index, const Eigen::Vector3d& origin) {
  const Eigen::Vector3i& corners = mesh.triangles[index];
  Triangle triangle;
  for (int k = 0; k < 3; ++k)
    triangle[static_cast<std::size_t>(k)] =
        mesh.vertices[static_cast<std::size_t>(corners[k])].cast<double>() - origin;
  return triangle;
}

/// The tree culls by a sphere around the box's centre; what is nearer to the box than the best so
/// far lies within that plus half the box's diagonal. Padded against the tree's single precision.
float searchRadius(double distance, const Eigen::Vector3d& half_extents) {
  return static_cast<float>((distance + half_extents.norm()) * (1.0 + 1e-5) + 1e-3);
}

bool visitTriangle(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<DistanceQuery*>(arguments->userPtr);
  const Triangle triangle = triangleAt(*query.mesh, arguments->primID, query.centre);
  const double squared = boxTriangleDistanceSquared(query.half_extents, triangle);
  if (squared >= query.best_squared) return false;
  query.best_squared = squared;
  arguments->query->radius = searchRadius(std::sqrt(squared), query.half_extents);
  return true;
}

bool visitTriangleForPoint(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<DistanceQuery*>(arguments->userPtr);
  const Triangle triangle = triangleAt(*query.mesh, arguments->primID, query.centre);
  const double squared = pointTriangleDistanceSquared(Eigen::Vector3d::Zero(), triangle);
  if (squared >= query.best_squared) return false;
  query.best_squared = squared;
  arguments->query->radius = searchRadius(std::sqrt(squared), Eigen::Vector3d::Zero());
  return true;
}

/// What all rays of a fan share; Embree leaves it as it is.
void setOrigin(const Eigen::Vector3f& origin, RTCRayHit8& packet) {
  for (std::size_t k = 0; k < kPacket; ++k) {
    packet.ray.org_x[k] = origin.x();
    packet.ray.org_y[k] = origin.y();
    packet.ray.org_z[k] = origin.z();
    packet.ray.tnear[k] = 0.0F;
    packet.ray.mask[k] = ~0U;
    packet.ray.flags[k] = 0;
    packet.ray.time[k] = 0.0F;
    packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Rays traced together, and the planes of the triangles they hit.
struct Batch {
  alignas(32) float x[kBatch];  ///< Directions.
  alignas(32) float y[kBatch];
  alignas(32) float z[kBatch];
  alignas(32) float embree_range[kBatch];
  alignas(32) double normal_x[kBatch];
  alignas(32) double normal_y[kBatch];
  alignas(32) double normal_z[kBatch];
  alignas(32) double height[kBatch];  ///< Of the planes above the origin, in lengths of normals.
};

/// Places behind the last of `count` rays repeat it.
SPELUNK_WIDE_IF_POSSIBLE void takeDirections(const Eigen::Vector3f* directions, std::size_t count,
                                             Batch& batch) {
  const float* from = directions->data();
  for (std::size_t k = 0; k < count; ++k) {
    batch.x[k] = from[3 * k];
    batch.y[k] = from[3 * k + 1];
    batch.z[k] = from[3 * k + 2];
  }
  std::fill(batch.x + count, std::end(batch.x), batch.x[count - 1]);
  std::fill(batch.y + count, std::end(batch.y), batch.y[count - 1]);
  std::fill(batch.z + count, std::end(batch.z), batch.z[count - 1]);
}

void aim(const Batch& batch, std::size_t first, float range_max, RTCRayHit8& packet) {
  std::copy_n(batch.x + first, kPacket, packet.ray.dir_x);
  std::copy_n(batch.y + first, kPacket, packet.ray.dir_y);
  std::copy_n(batch.z + first, kPacket, packet.ray.dir_z);
  std::fill_n(packet.ray.tfar, kPacket, range_max);
  std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
}

/// Embree says which triangle a ray hits; how far that is follows from the triangle's plane.
/// Embree's own range comes from approximate reciprocals that differ between processors; it
/// serves for rays that lie in the triangle, whose plane says nothing.
inline float rangeTo(double height, double slope, float embree_range) {
  const auto range = static_cast<float>(height / slope);
  return std::abs(range - embree_range) < kRangeDoubt ? std::max(0.0F, range) : embree_range;
}

SPELUNK_WIDE_IF_POSSIBLE void findRanges(const Batch& batch, std::size_t count, float* ranges) {
  for (std::size_t k = 0; k < count; ++k) {
    const double x = batch.x[k], y = batch.y[k], z = batch.z[k];
    const double slope =
        batch.normal_x[k] * x + (batch.normal_y[k] * y + batch.normal_z[k] * z);  // as Eigen adds
    ranges[k] = rangeTo(batch.height[k], slope, batch.embree_range[k]);
  }
}

}  // namespace

struct MeshScene::Impl {
  explicit Impl(const WorldMesh& world)
      : mesh(world), planes(planesOf(world)), device(makeDevice()) {
    scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // else a ray in millions slips through an edge
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      for (int k = 0; k < 3; ++k) *vertices++ = vertex[k];
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      for (int k = 0; k < 3; ++k) *indices++ = static_cast<unsigned>(triangle[k]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw OutsideError("Embree cannot build the world '" + mesh.name + "' (error " +
                         std::to_string(error) + "); check the mesh");
  }
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  double search(DistanceQuery query, double limit_m, RTCPointQueryFunction visit) const {
    alignas(16) RTCPointQuery ball{};
    ball.x = static_cast<float>(query.centre.x());
    ball.y = static_cast<float>(query.centre.y());
    ball.z = static_cast<float>(query.centre.z());
    ball.radius = searchRadius(limit_m, query.half_extents);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &ball, &context, visit, &query);
    return std::sqrt(query.best_squared);
  }

  /// Takes what the rays of one packet hit to the places from `first` on.
  void takeHits(const RTCRayHit8& packet, const Eigen::Vector3d& origin, std::size_t first,
                Batch& batch) const {
    for (std::size_t lane = 0; lane < kPacket; ++lane) {
      const bool is_hit = packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
      const Plane& plane = is_hit ? planes[packet.hit.primID[lane]] : no_plane;
      const std::size_t k = first + lane;
      batch.normal_x[k] = plane.normal.x();
      batch.normal_y[k] = plane.normal.y();
      batch.normal_z[k] = plane.normal.z();
      batch.height[k] = plane.offset - plane.normal.dot(origin);
      batch.embree_range[k] = packet.ray.tfar[lane];
    }
  }

  WorldMesh mesh;
  std::vector<Plane> planes;                     ///< One a triangle.
  Plane no_plane{Eigen::Vector3d::Zero(), 0.0};  ///< Leaves the range of a miss as it is.
  RTCDevice device;
  RTCScene scene = nullptr;
};

MeshScene::MeshScene(const WorldMesh& mesh) {
  require(!mesh.triangles.empty(), "MeshScene: the mesh holds no triangles");
  impl_ = std::make_unique<Impl>(mesh);
}
MeshScene::~MeshScene() = default;
MeshScene::MeshScene(MeshScene&&) noexcept = default;

void MeshScene::castFan(const Eigen::Vector3f& origin,
                        const std::vector<Eigen::Vector3f>& directions, float range_max,
                        std::vector<float>& ranges) const {
  ranges.resize(directions.size());
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) std::array<RTCRayHit8, kPackets> packets;
  for (RTCRayHit8& packet : packets) setOrigin(origin, packet);
  const Eigen::Vector3d from = origin.cast<double>();
  Batch batch;
  for (std::size_t first = 0; first < directions.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, directions.size() - first);
    const std::size_t filled = (count + kPacket - 1) / kPacket;
    takeDirections(&directions[first], count, batch);
    for (std::size_t k = 0; k < filled; ++k) aim(batch, k * kPacket, range_max, packets[k]);
    rtcIntersectNM(impl_->scene, &context, reinterpret_cast<RTCRayHitN*>(packets.data()), kPacket,
                   static_cast<unsigned>(filled), sizeof(RTCRayHit8));
    for (std::size_t k = 0; k < filled; ++k) impl_->takeHits(packets[k], from, k * kPacket, batch);
    findRanges(batch, count, &ranges[first]);
  }
}

std::optional<RayHit> MeshScene::castRay(const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction, double range_max) const {
  const Eigen::Vector3f from = origin.cast<float>();
  const Eigen::Vector3f along = direction.cast<float>();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  alignas(16) RTCRayHit query{};
  query.ray.org_x = from.x();
  query.ray.org_y = from.y();
  query.ray.org_z = from.z();
  query.ray.dir_x = along.x();
  query.ray.dir_y = along.y();
  query.ray.dir_z = along.z();
  query.ray.tfar = static_cast<float>(range_max);
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Plane& plane = impl_->planes[query.hit.primID];
  const Eigen::Vector3d normal = plane.normal.normalized();
  const Eigen::Vector3d start = from.cast<double>();
  const double height = plane.offset - plane.normal.dot(start);
  return RayHit{rangeTo(height, plane.normal.dot(along.cast<double>()), query.ray.tfar),
                normal.dot(direction) > 0.0 ? Eigen::Vector3d(-normal) : normal};
}

double MeshScene::distanceTo(const Eigen::Vector3d& point, double limit_m) const {
  require(limit_m >= 0.0 && point.allFinite(), "MeshScene::distanceTo: bad point or limit");
  return impl_->search({&impl_->mesh, point, Eigen::Vector3d::Zero(), limit_m * limit_m}, limit_m,
                       visitTriangleForPoint);
}

double MeshScene::boxDistance(const Eigen::Vector3d& centre, const Eigen::Vector3d& size,
                              double limit_m) const {
  require(limit_m >= 0.0 && centre.allFinite() && (size.array() >= 0.0).all(),
          "MeshScene::boxDistance: bad box or limit");
  return impl_->search({&impl_->mesh, centre, 0.5 * size, limit_m * limit_m}, limit_m,
                       visitTriangle);
}

}  // namespace spelunk::sim
