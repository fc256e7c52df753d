#include "mesh_voxels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace spelunk::evaluation {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Whether a triangle meets boxes of one size: separating axes (Akenine-Moeller, Fast 3D
/// Triangle-Box Overlap Testing, Journal of Graphics Tools 6(1), 2001), with all that depends on
/// the triangle alone worked out once. The three axes of the box are the caller's.
class TriangleTest {
 public:
  TriangleTest(const Triangle& triangle, const Eigen::Vector3d& half) {
    const std::array<Eigen::Vector3d, 3> edges{triangle[1] - triangle[0], triangle[2] - triangle[1],
                                               triangle[0] - triangle[2]};
    add(edges[0].cross(edges[1]), triangle, half);
    for (const Eigen::Vector3d& edge : edges)
      for (int i = 0; i < 3; ++i) add(Eigen::Vector3d::Unit(i).cross(edge), triangle, half);
  }

  /// The boxes of a row along x that the triangle meets, by the x of their centres; empty if
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
    double low = 0.0;  ///< A box whose centre lies outside [low, high] along the axis is parted.
    double high = 0.0;
  };

  void add(const Eigen::Vector3d& axis, const Triangle& triangle, const Eigen::Vector3d& half) {
    const std::array<double, 3> along{axis.dot(triangle[0]), axis.dot(triangle[1]),
                                      axis.dot(triangle[2])};
    const double reach = half.dot(axis.cwiseAbs());
    slabs_[count_++] = {axis, *std::min_element(along.begin(), along.end()) - reach,
                        *std::max_element(along.begin(), along.end()) + reach};
  }

  std::array<Slab, 10> slabs_;
  std::size_t count_ = 0;
};

/// Boxes of one size around the centres of the voxels, and which of them a triangle meets.
struct VoxelBoxes {
  VoxelBoxes(const Triangle& triangle, double half_m, const VoxelGrid& grid)
      : test(triangle, Eigen::Vector3d::Constant(half_m)) {
    const Eigen::Vector3d low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
    const Eigen::Vector3d high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(half_m);
    first = (grid.scaled(low - reach).array() - 0.5).ceil().cast<int>();
    last = (grid.scaled(high + reach).array() - 0.5).floor().cast<int>();
  }

  /// The first and the last x of the boxes of a row that the triangle meets; first > last if none.
  [[nodiscard]] std::pair<int, int> row(int y, int z, const VoxelGrid& grid) const {
    if (y < first.y() || y > last.y() || z < first.z() || z > last.z()) return {1, 0};
    const Eigen::Vector3d centre = grid.centreOf({0, y, z});
    const auto [from, to] = test.rowMet(centre.y(), centre.z());
    const double edge = grid.resolution();
    const double begin = std::max<double>(first.x(), std::ceil((from - centre.x()) / edge));
    const double end = std::min<double>(last.x(), std::floor((to - centre.x()) / edge));
    return begin <= end ? std::pair{static_cast<int>(begin), static_cast<int>(end)}
                        : std::pair{1, 0};
  }

  TriangleTest test;
  Eigen::Vector3i first;
  Eigen::Vector3i last;
};

/// A thin plate on the faces that voxels share with the next ones along an axis.
class FacePlate {
 public:
  FacePlate(const Triangle& triangle, double edge_m, int axis)
      : half_(halfOf(edge_m, axis)),
        offset_(0.5 * edge_m * Eigen::Vector3d::Unit(axis)),
        low_(triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]) - half_),
        high_(triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]) + half_),
        test_(triangle, half_) {}

  [[nodiscard]] bool isMetAt(const Eigen::Vector3d& voxel_centre) const {
    const Eigen::Vector3d centre = voxel_centre + offset_;
    if ((centre.array() < low_.array()).any() || (centre.array() > high_.array()).any())
      return false;
    const auto [from, to] = test_.rowMet(centre.y(), centre.z());
    return from <= centre.x() && centre.x() <= to;
  }

 private:
  static Eigen::Vector3d halfOf(double edge_m, int axis) {
    Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * edge_m - kFlush_m);
    half(axis) = 2.0 * kFlush_m;
    return half;
  }

  Eigen::Vector3d half_;
  Eigen::Vector3d offset_;
  Eigen::Vector3d low_;
  Eigen::Vector3d high_;
  TriangleTest test_;
};

/// Enters one triangle after the other.
class Marker {
 public:
  Marker(VoxelGrid& met, VoxelGrid& touched, std::vector<std::size_t>& walls)
      : met_(met), touched_(touched), walls_(walls) {}

  void mark(const Triangle& triangle) {
    const double half_m = 0.5 * met_.resolution();
    const VoxelBoxes inner(triangle, half_m - kFlush_m, met_);
    const VoxelBoxes outer(triangle, half_m + 2.0 * kFlush_m, met_);
    plates_.reset();
    for (int z = outer.first.z(); z <= outer.last.z(); ++z)
      for (int y = outer.first.y(); y <= outer.last.y(); ++y) {
        const auto [begin, end] = outer.row(y, z, met_);
        if (begin > end) continue;
        const auto [met_begin, met_end] = inner.row(y, z, met_);
        for (int x = begin; x <= end; ++x) {
          if (met_begin <= x && x <= met_end)
            met_.set(met_.offsetOf({x, y, z}));
          else
            touch(triangle, {x, y, z});
        }
      }
  }

 private:
  void touch(const Triangle& triangle, const Eigen::Vector3i& cell) {
    const double edge_m = met_.resolution();
    if (!plates_)
      plates_.emplace(std::array{FacePlate(triangle, edge_m, 0), FacePlate(triangle, edge_m, 1),
                                 FacePlate(triangle, edge_m, 2)});
    const std::size_t offset = met_.offsetOf(cell);
    touched_.set(offset);
    const Eigen::Vector3d centre = met_.centreOf(cell);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((*plates_)[axis].isMetAt(centre)) walls_.push_back(3 * offset + axis);
  }

  VoxelGrid& met_;
  VoxelGrid& touched_;
  std::vector<std::size_t>& walls_;
  std::optional<std::array<FacePlate, 3>> plates_;  ///< Few triangles touch without meeting.
};

}  // namespace

MeshVoxels::MeshVoxels(const sim::WorldMesh& mesh, double resolution_m)
    : met_(mesh.bounds(), resolution_m), touched_(mesh.bounds(), resolution_m) {
  const AxisAlignedBox bounds = mesh.bounds();
  const Eigen::Vector3d rim = Eigen::Vector3d::Constant(kFlush_m);
  first_ = met_.cellOf(bounds.min + rim);
  last_ = met_.cellOf(bounds.max - rim);
  Marker marker(met_, touched_, walls_);
  for (const Eigen::Vector3i& corners : mesh.triangles) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i)
      triangle[static_cast<std::size_t>(i)] =
          mesh.vertices[static_cast<std::size_t>(corners[i])].cast<double>();
    marker.mark(triangle);
  }
  std::sort(walls_.begin(), walls_.end());
  walls_.erase(std::unique(walls_.begin(), walls_.end()), walls_.end());
}

bool MeshVoxels::joins(std::size_t offset, int axis) const {
  const std::size_t next = offset + met_.offsetOf(Eigen::Vector3i::Unit(axis));
  if (met_.isSet(offset) || met_.isSet(next)) return false;
  if (!touched_.isSet(offset) || !touched_.isSet(next)) return true;
  return !std::binary_search(walls_.begin(), walls_.end(),
                             3 * offset + static_cast<std::size_t>(axis));
}

VoxelGrid MeshVoxels::takeSurface() && {
  touched_.forEachSet([this](std::size_t offset) { met_.set(offset); });
  return std::move(met_);
}

}  // namespace spelunk::evaluation
