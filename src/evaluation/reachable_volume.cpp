#include "spelunk/evaluation/reachable_volume.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "spelunk/common/contract.h"
#include "spelunk/evaluation/voxel_grid.h"

namespace spelunk::evaluation {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Whether a triangle meets cubes of one size: separating axes (Akenine-Moeller, Fast 3D
/// Triangle-Box Overlap Testing, Journal of Graphics Tools 6(1), 2001), with all that depends on
/// the triangle alone worked out once. The three axes of the cube are the caller's bounding box.
class TriangleTest {
 public:
  TriangleTest(const Triangle& triangle, double half_edge) {
    const std::array<Eigen::Vector3d, 3> edges{triangle[1] - triangle[0], triangle[2] - triangle[1],
                                               triangle[0] - triangle[2]};
    add(edges[0].cross(edges[1]), triangle, half_edge);
    for (const Eigen::Vector3d& edge : edges)
      for (int i = 0; i < 3; ++i) add(Eigen::Vector3d::Unit(i).cross(edge), triangle, half_edge);
  }

  [[nodiscard]] bool meetsCubeAt(const Eigen::Vector3d& centre) const {
    for (const Slab& slab : slabs_) {
      const double at = slab.axis.dot(centre);
      if (at < slab.low || at > slab.high) return false;
    }
    return true;
  }

 private:
  struct Slab {
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    double low = 0.0;  ///< A cube whose centre lies outside [low, high] along the axis is parted.
    double high = 0.0;
  };

  void add(const Eigen::Vector3d& axis, const Triangle& triangle, double half_edge) {
    const std::array<double, 3> along{axis.dot(triangle[0]), axis.dot(triangle[1]),
                                      axis.dot(triangle[2])};
    const double reach = half_edge * axis.cwiseAbs().sum();
    slabs_[count_++] = {axis, *std::min_element(along.begin(), along.end()) - reach,
                        *std::max_element(along.begin(), along.end()) + reach};
  }

  std::array<Slab, 10> slabs_;
  std::size_t count_ = 0;
};

void markTriangle(const Triangle& triangle, VoxelGrid& surface) {
  const Eigen::Vector3d low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
  const Eigen::Vector3d high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
  const Eigen::Vector3i first = surface.cellOf(low);
  const Eigen::Vector3i last = surface.cellOf(high);
  const TriangleTest test(triangle, 0.5 * surface.resolution());
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x)
        if (test.meetsCubeAt(surface.centreOf({x, y, z}))) surface.set(surface.offsetOf({x, y, z}));
}

VoxelGrid surfaceOf(const sim::WorldMesh& mesh, double resolution_m) {
  VoxelGrid surface(mesh.bounds(), resolution_m);
  for (const Eigen::Vector3i& corners : mesh.triangles) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i)
      triangle[static_cast<std::size_t>(i)] =
          mesh.vertices[static_cast<std::size_t>(corners[i])].cast<double>();
    markTriangle(triangle, surface);
  }
  return surface;
}

/// The free voxels joined to a start.
struct Flood {
  VoxelGrid reached;
  std::size_t voxels = 0;
  bool leaks = false;
};

Flood floodFrom(const Eigen::Vector3i& start, const VoxelGrid& surface, VoxelGrid empty) {
  Flood flood{std::move(empty)};
  std::vector<Eigen::Vector3i> open;
  const auto visit = [&](const Eigen::Vector3i& cell) {
    if (!surface.contains(cell)) {
      flood.leaks = true;
      return;
    }
    const std::size_t offset = surface.offsetOf(cell);
    if (surface.isSet(offset) || !flood.reached.set(offset)) return;
    ++flood.voxels;
    open.push_back(cell);
  };
  visit(start);
  while (!open.empty()) {
    const Eigen::Vector3i cell = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) visit(cell + side * Eigen::Vector3i::Unit(axis));
  }
  return flood;
}

bool touches(const VoxelGrid& reached, const Eigen::Vector3i& cell) {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Eigen::Vector3i neighbour = cell + Eigen::Vector3i(x, y, z);
        if (reached.contains(neighbour) && reached.isSet(reached.offsetOf(neighbour))) return true;
      }
  return false;
}

std::size_t countTouched(const VoxelGrid& surface, const VoxelGrid& reached) {
  std::size_t count = 0;
  for (int z = 0; z < surface.size().z(); ++z)
    for (int y = 0; y < surface.size().y(); ++y)
      for (int x = 0; x < surface.size().x(); ++x) {
        const Eigen::Vector3i cell(x, y, z);
        if (surface.isSet(surface.offsetOf(cell)) && touches(reached, cell)) ++count;
      }
  return count;
}

}  // namespace

ReachableVolume reachableVolume(const sim::WorldMesh& mesh, const Eigen::Vector3d& start,
                                double resolution_m) {
  const VoxelGrid surface = surfaceOf(mesh, resolution_m);
  const Eigen::Vector3i cell = surface.cellOf(start);
  if (!surface.contains(cell))
    throw OutsideError("the start lies outside the mesh '" + mesh.name +
                       "': choose one inside with --start x,y,z,yaw");
  if (surface.isSet(surface.offsetOf(cell)))
    throw OutsideError("the start lies in the surface of the mesh '" + mesh.name +
                       "': choose one in free space with --start x,y,z,yaw");
  const Flood flood = floodFrom(cell, surface, VoxelGrid(mesh.bounds(), resolution_m));
  const std::size_t touched = countTouched(surface, flood.reached);
  const double voxel_m3 = resolution_m * resolution_m * resolution_m;
  return {static_cast<double>(flood.voxels) * voxel_m3, static_cast<double>(touched) * voxel_m3,
          static_cast<double>(flood.voxels + touched) * voxel_m3, flood.leaks};
}

}  // namespace spelunk::evaluation
