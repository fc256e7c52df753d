#include "mesh_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace spelunk::sim {
namespace {

/// Of the largest coordinate. Each of three vertices is off by up to half a step of single
/// precision (2^-24) along each axis, which moves a corner from the line of the others by up to
/// 2 sqrt(3) of that.
constexpr double kRounding = 1.0 / (1 << 22);

/// Whether three corners lie on one line, as exactly as single precision says.
bool isFlat(const std::array<Eigen::Vector3f, 3>& corners) {
  const Eigen::Vector3d a = corners[0].cast<double>();
  const Eigen::Vector3d b = corners[1].cast<double>();
  const Eigen::Vector3d c = corners[2].cast<double>();
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  const double largest =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  return (b - a).cross(c - a).norm() <= kRounding * largest * longest;
}

}  // namespace

std::size_t MeshBuilder::BitsHash::operator()(const Bits& bits) const {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const std::uint32_t part : bits) hash = (hash ^ part) * 0x9E3779B97F4A7C15ULL;
  return static_cast<std::size_t>(hash ^ (hash >> 32));
}

void MeshBuilder::addTriangle(const std::array<Eigen::Vector3f, 3>& corners) {
  if (!std::all_of(corners.begin(), corners.end(), [](const auto& v) { return v.allFinite(); })) {
    ++broken_;
    return;
  }
  if (isFlat(corners)) {
    ++flat_;
    return;
  }
  const Eigen::Vector3i triangle(indexOf(corners[0]), indexOf(corners[1]), indexOf(corners[2]));
  Bits key{static_cast<std::uint32_t>(triangle[0]), static_cast<std::uint32_t>(triangle[1]),
           static_cast<std::uint32_t>(triangle[2])};
  std::sort(key.begin(), key.end());
  if (corners_.insert(key).second)
    mesh_.triangles.push_back(triangle);
  else
    ++repeated_;
}

int MeshBuilder::indexOf(const Eigen::Vector3f& vertex) {
  const Eigen::Vector3f unsigned_zero = vertex + Eigen::Vector3f::Zero();  // -0 becomes +0
  Bits bits{};
  std::memcpy(bits.data(), unsigned_zero.data(), sizeof(bits));
  const auto [entry, is_new] = index_.try_emplace(bits, static_cast<int>(mesh_.vertices.size()));
  if (is_new) mesh_.vertices.push_back(unsigned_zero);
  return entry->second;
}

}  // namespace spelunk::sim
