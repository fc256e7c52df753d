#include "spelunk/evaluation/reachable_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "spelunk/common/contract.h"
#include "spelunk/evaluation/voxel_grid.h"

namespace spelunk::evaluation {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

bool isParting(const Eigen::Vector3d& axis, const Triangle& t, double half) {
  const double a = axis.dot(t[0]);
  const double b = axis.dot(t[1]);
  const double c = axis.dot(t[2]);
  const double reach = half * axis.cwiseAbs().sum();
  return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
}

/// Whether a triangle meets the cube of half edge `half` around the origin (separating axes;
/// Akenine-Moeller, Fast 3D Triangle-Box Overlap Testing, Journal of Graphics Tools 6(1), 2001).
bool meetsCube(const Triangle& t, double half) {
  for (int i = 0; i < 3; ++i)
    if (isParting(Eigen::Vector3d::Unit(i), t, half)) return false;
  const std::array<Eigen::Vector3d, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  if (isParting(edges[0].cross(edges[1]), t, half)) return false;
  for (const Eigen::Vector3d& edge : edges)
    for (int i = 0; i < 3; ++i)
      if (isParting(Eigen::Vector3d::Unit(i).cross(edge), t, half)) return false;
  return true;
}

void markTriangle(const Triangle& triangle, VoxelGrid& surface) {
  const Eigen::Vector3d low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
  const Eigen::Vector3d high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
  const Eigen::Vector3i first = surface.cellOf(low);
  const Eigen::Vector3i last = surface.cellOf(high);
  const double half = 0.5 * surface.resolution();
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const Eigen::Vector3d centre = surface.centreOf({x, y, z});
        if (meetsCube({triangle[0] - centre, triangle[1] - centre, triangle[2] - centre}, half))
          surface.set(surface.offsetOf({x, y, z}));
      }
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

/// The free voxels joined to `start`, counted into `volume`; its surface voxels as they are met.
class Flood {
 public:
  Flood(const VoxelGrid& surface, const AxisAlignedBox& bounds, double resolution_m)
      : surface_(surface), reached_(bounds, resolution_m) {}

  ReachableVolume fill(const Eigen::Vector3i& start) {
    visit(start);
    while (!open_.empty()) {
      const Eigen::Vector3i cell = open_.back();
      open_.pop_back();
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) visit(cell + side * Eigen::Vector3i::Unit(axis));
      touchNeighbours(cell);
    }
    const double voxel = std::pow(surface_.resolution(), 3);
    return {static_cast<double>(free_) * voxel, static_cast<double>(touched_) * voxel,
            static_cast<double>(free_ + touched_) * voxel, leaks_};
  }

 private:
  void visit(const Eigen::Vector3i& cell) {
    if (!surface_.contains(cell)) {
      leaks_ = true;
      return;
    }
    const std::size_t offset = surface_.offsetOf(cell);
    if (surface_.isSet(offset) || !reached_.set(offset)) return;
    ++free_;
    open_.push_back(cell);
  }

  void touchNeighbours(const Eigen::Vector3i& cell) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const Eigen::Vector3i neighbour = cell + Eigen::Vector3i(x, y, z);
          if (!surface_.contains(neighbour)) continue;
          const std::size_t offset = surface_.offsetOf(neighbour);
          if (surface_.isSet(offset) && reached_.set(offset)) ++touched_;
        }
  }

  const VoxelGrid& surface_;
  VoxelGrid reached_;
  std::vector<Eigen::Vector3i> open_;
  std::size_t free_ = 0;
  std::size_t touched_ = 0;
  bool leaks_ = false;
};

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
  return Flood(surface, mesh.bounds(), resolution_m).fill(cell);
}

}  // namespace spelunk::evaluation
