#include "spelunk/sim/foothold_search.h"

#include <array>
#include <cmath>

namespace spelunk::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180.0;
constexpr double kRing_m = 0.05;        ///< From ring to ring of the search.
constexpr double kFootRadius_m = 0.04;  ///< The surroundings that are looked at for edges.
constexpr double kEdge_m = 0.03;        ///< Off the plane by more: the foot stands on an edge.
constexpr double kSightGap_m = 0.03;    ///< The line of sight ends so far above the foothold.

/// Eight directions of the compass, without trigonometry; the axes first.
constexpr double kDiagonal = 0.70710678118654752;
constexpr std::array<std::array<double, 2>, 8> kCompass{{{1, 0},
                                                         {-1, 0},
                                                         {0, 1},
                                                         {0, -1},
                                                         {kDiagonal, kDiagonal},
                                                         {-kDiagonal, kDiagonal},
                                                         {kDiagonal, -kDiagonal},
                                                         {-kDiagonal, -kDiagonal}}};

}  // namespace

FootholdSearch::FootholdSearch(const MeshScene& scene, const WalkerParams& params)
    : scene_(scene),
      search_m_(params.foothold_search_m),
      normal_z_min_(std::cos(params.foothold_slope_max_deg * kDegree)) {}

std::optional<Foothold> FootholdSearch::groundBelow(const Vector3d& from, double depth_m) const {
  const auto hit = scene_.castRay(from, -Vector3d::UnitZ(), depth_m);
  if (!hit) return std::nullopt;
  return Foothold{from - hit->range_m * Vector3d::UnitZ(), hit->normal};
}

bool FootholdSearch::isRockBetween(const Vector3d& a, const Vector3d& b) const {
  const double length = (b - a).norm();
  return length > 0.0 && scene_.castRay(a, (b - a) / length, length);
}

std::optional<Foothold> FootholdSearch::reachable(const Leg& leg, const Isometry3d& T_world_base,
                                                  const Vector3d& wanted) const {
  const Vector3d root = T_world_base * leg.root();
  const auto ground = groundBelow({wanted.x(), wanted.y(), root.z()}, leg.longest());
  if (!ground || ground->normal.z() < normal_z_min_) return std::nullopt;
  if (!leg.anglesFor(T_world_base.inverse() * ground->position)) return std::nullopt;
  const Vector3d sight = ground->position + kSightGap_m * ground->normal - root;
  const double length = sight.norm();
  if (scene_.castRay(root, sight / length, length)) return std::nullopt;
  return ground;
}

bool FootholdSearch::isFlatAround(const Foothold& foothold) const {
  const double reach = kFootRadius_m + kEdge_m;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3d offset(kFootRadius_m * kCompass[k][0], kFootRadius_m * kCompass[k][1], 0.0);
    const double rise = -foothold.normal.dot(offset) / foothold.normal.z();
    const auto beside =
        groundBelow(foothold.position + offset + Vector3d(0.0, 0.0, rise + reach), 2.0 * reach);
    if (!beside || std::abs(beside->position.z() - foothold.position.z() - rise) > kEdge_m)
      return false;
  }
  return true;
}

std::optional<Foothold> FootholdSearch::find(const Leg& leg, const Isometry3d& T_world_base,
                                             const Vector3d& wanted) const {
  std::optional<Foothold> on_an_edge;
  const int rings = static_cast<int>(std::floor(search_m_ / kRing_m + 1e-9));
  for (int ring = 0; ring <= rings; ++ring) {
    for (std::size_t k = 0; k < (ring == 0 ? 1 : kCompass.size()); ++k) {
      const Vector3d offset(ring * kRing_m * kCompass[k][0], ring * kRing_m * kCompass[k][1], 0.0);
      const auto candidate = reachable(leg, T_world_base, wanted + offset);
      if (!candidate) continue;
      if (isFlatAround(*candidate)) return candidate;
      if (!on_an_edge) on_an_edge = candidate;
    }
  }
  return on_an_edge;
}

}  // namespace spelunk::sim
