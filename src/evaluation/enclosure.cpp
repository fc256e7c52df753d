#include "enclosure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace spelunk::evaluation {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

double windingNumber(const sim::WorldMesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0.0;  // of half the solid angles
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices[static_cast<std::size_t>(triangle[k])].cast<double>() - point;
    };
    const Eigen::Vector3d a = corner(0);
    const Eigen::Vector3d b = corner(1);
    const Eigen::Vector3d c = corner(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * kPi);
}

bool isSurrounded(const sim::WorldMesh& mesh, const Eigen::Vector3d& point) {
  return std::abs(windingNumber(mesh, point)) >= 0.5;
}

bool isClosed(const sim::WorldMesh& mesh) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      edges.push_back(static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high));
    }
  std::sort(edges.begin(), edges.end());
  for (auto first = edges.begin(); first != edges.end();) {
    const auto next = std::upper_bound(first, edges.end(), *first);
    if ((next - first) % 2 != 0) return false;
    first = next;
  }
  return true;
}

bool isEnclosed(const sim::WorldMesh& mesh, const Eigen::Vector3d& point) {
  return isClosed(mesh) && isSurrounded(mesh, point);
}

}  // namespace spelunk::evaluation
