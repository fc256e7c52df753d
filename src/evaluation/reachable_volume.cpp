#include "spelunk/evaluation/reachable_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

  /// The cubes of a row along x that the triangle meets, by the x of their centres; empty if
  /// first > second.
  [[nodiscard]] std::pair<double, double> rowMet(double y, double z) const {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    for (const Slab& slab : slabs_) {
      const double rest = slab.axis.y() * y + slab.axis.z() * z;
      if (slab.axis.x() == 0.0) {
        if (rest < slab.low || rest > slab.high) return {1.0, 0.0};
        continue;
      }
      const double from = (slab.low - rest) / slab.axis.x();
      const double to = (slab.high - rest) / slab.axis.x();
      low = std::max(low, std::min(from, to));
      high = std::min(high, std::max(from, to));
    }
    return {low, high};
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
  const double edge = surface.resolution();
  const TriangleTest test(triangle, 0.5 * edge);
  const double x_first = surface.centreOf(first).x();
  const double columns = last.x() - first.x();
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y) {
      const Eigen::Vector3i row(first.x(), y, z);
      const Eigen::Vector3d centre = surface.centreOf(row);
      const auto [from, to] = test.rowMet(centre.y(), centre.z());
      const double begin = std::max(0.0, std::ceil((from - x_first) / edge));
      const double end = std::min(columns, std::floor((to - x_first) / edge));
      const std::size_t offset = surface.offsetOf(row);
      for (double x = begin; x <= end; ++x) surface.set(offset + static_cast<std::size_t>(x));
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

/// Whether a cell has no neighbour beyond a side of the grid.
bool isInside(const VoxelGrid& grid, const Eigen::Vector3i& cell) {
  return (cell.array() > 0).all() && (cell.array() + 1 < grid.size().array()).all();
}

/// Fills the free voxels joined to a start.
void flood(const Eigen::Vector3i& start, const VoxelGrid& surface, ReachableSpace& space) {
  std::vector<std::size_t> open;
  const auto visit = [&](std::size_t offset) {
    if (surface.isSet(offset) || !space.free.set(offset)) return;
    ++space.free_voxels;
    open.push_back(offset);
  };
  visit(surface.offsetOf(start));
  while (!open.empty()) {
    const std::size_t offset = open.back();
    open.pop_back();
    const Eigen::Vector3i cell = surface.cellAt(offset);
    space.leaks = space.leaks || !isInside(surface, cell);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t stride = surface.offsetOf(Eigen::Vector3i::Unit(axis));
      if (cell(axis) > 0) visit(offset - stride);
      if (cell(axis) + 1 < surface.size()(axis)) visit(offset + stride);
    }
  }
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

void keepTouched(const VoxelGrid& surface, ReachableSpace& space) {
  surface.forEachSet([&](std::size_t offset) {
    if (!touches(space.free, surface.cellAt(offset))) return;
    space.surface.set(offset);
    ++space.surface_voxels;
  });
}

}  // namespace

ReachableSpace reachableSpace(const sim::WorldMesh& mesh, const Eigen::Vector3d& start,
                              double resolution_m) {
  const VoxelGrid surface = surfaceOf(mesh, resolution_m);
  const Eigen::Vector3i cell = surface.cellOf(start);
  if (!surface.contains(cell))
    throw OutsideError("the start lies outside the mesh '" + mesh.name +
                       "': choose one inside with --start x,y,z,yaw");
  if (surface.isSet(surface.offsetOf(cell)))
    throw OutsideError("the start lies in the surface of the mesh '" + mesh.name +
                       "': choose one in free space with --start x,y,z,yaw");
  ReachableSpace space{VoxelGrid(mesh.bounds(), resolution_m),
                       VoxelGrid(mesh.bounds(), resolution_m)};
  flood(cell, surface, space);
  keepTouched(surface, space);
  return space;
}

ReachableVolume reachableVolume(const sim::WorldMesh& mesh, const Eigen::Vector3d& start,
                                double resolution_m) {
  const ReachableSpace space = reachableSpace(mesh, start, resolution_m);
  const double voxel_m3 = resolution_m * resolution_m * resolution_m;
  return {static_cast<double>(space.free_voxels) * voxel_m3,
          static_cast<double>(space.surface_voxels) * voxel_m3,
          static_cast<double>(space.free_voxels + space.surface_voxels) * voxel_m3, space.leaks};
}

}  // namespace spelunk::evaluation
